// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral {

/// A pose that a grouper considered, and how good it took it to be.
struct ScoredPose {
  RigidTransform target_from_source;
  double score = 0;  ///< larger is better
};

/// A number that says how a result came about, such as how often a bound was reached.
struct Note {
  std::string name;  ///< "steps", "halvings"
  std::int64_t count = 0;
};

/// The result of a grouper.
struct GroupingResult {
  Indices selected;            ///< rows it keeps, strictly ascending; may be empty
  std::vector<double> scores;  ///< one per match, larger is better; empty if the grouper computes none
  std::optional<RigidTransform> target_from_source;  ///< the grouper's own pose; absent if it estimates none
  std::vector<ScoredPose>
      runner_up;            ///< poses far from the chosen one and from each other, the best first; if asked for
  std::vector<Note> notes;  ///< empty if there is nothing to say
  std::optional<double> confidence = {};  ///< probability that its pose is right, of a method that states one
};

// With each grouper is declared
//
//   double working_memory(int matches, const <Grouper>Options& options);
//
// its peak memory in bytes for this many matches, including the result and excluding the table.

/// A grouper with its options bound: a pure function of the table.
using GroupFunction = std::function<GroupingResult(const CorrespondenceSet&)>;

}  // namespace corral
