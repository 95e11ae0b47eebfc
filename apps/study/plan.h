// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/study/work_list.h"

namespace corral {

/// What a unit is expected to take, from the sizes of its files alone: nothing is read before work begins.
///
///   V = bytes / 40 of the source, W of the target     M = V / (6 r^2) matches, r = the detector's length in pr; of a table,
///   bytes / 100
///   time = a + b (V + W) + c M W + call_nanoseconds(grouper, M) of each call of a grouper + dense f (V + W)
///
/// Whole numbers throughout, so that every machine finds the same. The constants were scaled to the recorded times of one study
/// (paper/README.md): the split needs their proportions only, `corral plan --like` adapts the times to a machine.
struct UnitEstimate {
  std::uint64_t microseconds = 0;  ///< on one processor
  std::uint64_t bytes = 0;         ///< at most at a time

  double seconds() const { return static_cast<double>(microseconds) / 1e6; }
};
/// What a call of a grouper is expected to take on a table of M matches, with the refinement and the scores behind it: d M + e M^2
/// with an e for each grouper: of ST that on real tables of 100,000 matches (grouping/README.md), of SI
/// there, of GTM on 1,500 matches; of all others next to nothing.
std::uint64_t call_nanoseconds(const std::string& method, std::uint64_t matches);

/// The estimates of all units. A file that is not there has the size 0; its pair fails soon.
std::vector<UnitEstimate> estimate_units(const WorkList& list);

/// The shard of each unit, 1 .. shards: the largest unit first, each to the shard with the least work so far, the first of
/// those. It depends on the estimates alone, and so is the same on every machine that has the same data.
std::vector<int> split_units(const std::vector<UnitEstimate>& estimates, int shards);

/// What a shard is expected to take.
struct ShardPlan {
  int pairs = 0;          ///< units, that is pairs in one way of matching
  double seconds = 0;     ///< on one processor
  double peak_bytes = 0;  ///< with one pair at a time
};
/// `seconds`: the times of all units, where they are known better than by the estimates; the split follows those in any case.
std::vector<ShardPlan> plan_shards(const std::vector<UnitEstimate>& estimates, int shards,
                                   const std::vector<double>& seconds = {});

}  // namespace corral
