// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

struct FrameRansacOptions {
  int polish = 50;
  double tolerance_pr = 5;
  PoseScore score = PoseScore::Inliers;
  int refit_rounds = 20;
  int keep = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"polish", "", "", "best poses that are refitted before the choice; 0: none", at_least(0)},
          self.polish);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"score", "", "", "what a pose is worth"}, self.score);
    visit(OptionField{"refit_rounds", "", "", "weighted fits from each pose that is polished", at_least(0)},
          self.refit_rounds);
    visit(OptionField{"keep", "", "", "poses returned beside the chosen one", at_least(0)}, self.keep);
  }
};

/// One-point RANSAC with frames: the best of the poses that single matches propose by their frames.
///
///   R_i = L'_i^T L_i,   t_i = p'_i - R_i p_i       for every match with two valid frames that at least 3 agree with
///
/// They are ranked by score, then by mae, then in the order of the rows; of those that the same matches agree with, the first.
/// The `polish` first ones are refitted (refit() in pose_choice.h): 10 degrees of a frame are 17 pr at a distance of 100 pr, so
/// that a pose proposed finds the matches near its own. The best of these, by score and mae, selects the matches below the tolerance.
///
/// Source    the poses: [guo2013rotational]; the refit is ours.
/// Reads     source_points, target_points, source_frames, target_frames, resolution.
/// Returns   selected, the pose, and `keep` runners-up.
/// Cost      O(M^2) time, O(M) memory. Deterministic, without random draws: every match is tried. A pose that cannot be among
///           the first any more is dropped before all of its residuals are known (filter.h), unless `keep` or fs need them all.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns, frames absent.
/// Departs   Poses are counted by all matches and not clustered; the answer is that of the set of rows (canonical_order.h). A
///           product of frames that is off a rotation by more than 1e-9 is replaced by the nearest rotation. `polish` 0 is the
///           textbook form. Fewer than 3 matches in agreement: nothing selected, no pose.
GroupingResult group_by_frame_ransac(const CorrespondenceSet& matches, const FrameRansacOptions& options = {});
double working_memory(int matches, const FrameRansacOptions& options);

}  // namespace corral
