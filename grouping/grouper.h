// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral {

/// The result of a grouper.
struct GroupingResult {
  Indices selected;            ///< rows it keeps, strictly ascending; may be empty
  std::vector<double> scores;  ///< one per match, larger is better; empty if the grouper computes none
  std::optional<RigidTransform> target_from_source;  ///< the grouper's own pose; absent if it estimates none
};

// With each grouper is declared
//
//   double working_memory(int matches, const <Grouper>Options& options);
//
// its peak memory in bytes for this many matches, including the result and excluding the table.

/// A grouper with its options bound: a pure function of the table.
using GroupFunction = std::function<GroupingResult(const CorrespondenceSet&)>;

}  // namespace corral
