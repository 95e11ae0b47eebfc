// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grouping/grouper.h"

namespace corral {

/// What is asked of a grouper, and what it did.
struct ConformanceCheck {
  std::string name;                             ///< "empty table"
  std::optional<bool> holds;                    ///< absent where there is no right or wrong
  std::string text;                             ///< what it breaks, or what was measured
  std::optional<CorrespondenceSet> table = {};  ///< where it breaks it
};

/// The contract of every grouper, on made tables: it answers without matches and with 1 to 3; its rows are rows of the table,
/// ascending, each once, and its scores, if it has any, finite, one for each; rows that are not finite are refused, or not
/// selected; it gives the same answer twice, for the rows in another order, for lengths in another unit (1,024 times, exactly),
/// and when the target is moved (2 % of the rows may differ, by rounding), each on a table with 30 % and on one with 3 % correct matches; it keeps more correct matches than its share of an easy
/// table (half correct, noise of 0.3 pr), so that its refined pose registers it. Then the median time of three calls on 250 to
/// 2,000 matches, and the exponent of its growth. An exception is a broken check.
std::vector<ConformanceCheck> check_conformance(const GroupFunction& group);

}  // namespace corral
