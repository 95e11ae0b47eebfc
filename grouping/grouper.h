// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral {

/// What a grouper answers.
struct GroupingResult {
  Indices selected;            ///< rows it keeps, strictly ascending; may be empty
  std::vector<double> scores;  ///< one per match, larger is better; empty where the method scores no matches
  std::optional<RigidTransform> target_from_source;  ///< the method's own pose; absent where it makes none
};

// Beside each method stands
//
//   double working_memory(int matches, const <Method>Options& options);
//
// the most bytes that it will hold at a time for so many matches, the answer included and the table not.

/// A grouper with its options bound: a pure function of the table.
using GroupFunction = std::function<GroupingResult(const CorrespondenceSet&)>;

}  // namespace corral
