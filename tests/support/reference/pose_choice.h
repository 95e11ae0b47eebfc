// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "grouping/pose/pose_score.h"
#include "kernel/rigid_transform.h"
#include "tests/support/reference/groupers.h"

/// What groupers share that choose among poses, once more. The fits are those of kernel/, so that poses of equal worth up to
/// rounding are settled alike.
namespace corral::reference {

/// The selection of `select` for the rows in ascending order of all that they hold.
Selection in_canonical_order(const CorrespondenceSet& matches,
                             const std::function<Selection(const CorrespondenceSet&)>& select);

/// | |p_i - p_j| - |p'_i - p'_j| |, and the sum of the two lengths.
struct PairLengths {
  double difference, sum;
};
PairLengths pair_lengths(const CorrespondenceSet& matches, int i, int j);

/// Everything that a pose is compared by, over all rows.
struct PoseWorth {
  double score = 0, mae = 0;
  Indices agreeing;
  bool operator>(const PoseWorth& other) const { return score != other.score ? score > other.score : mae > other.mae; }
};
PoseWorth pose_worth(const CorrespondenceSet& matches, const RigidTransform& pose, PoseScore score,
                     double tolerance_pr);

/// The best pose visited by weighted fits to the rows that agree.
RigidTransform refitted(const CorrespondenceSet& matches, const RigidTransform& pose, PoseScore score,
                        double tolerance_pr, int rounds);

/// The rows below the tolerance of the best pose, refitted; nothing if they are fewer than 3. Not for Fs.
Selection rows_of_best_pose(const CorrespondenceSet& matches, const std::vector<RigidTransform>& poses, PoseScore score,
                            double tolerance_pr, int rounds);

}  // namespace corral::reference
