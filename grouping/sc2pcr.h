// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

struct Sc2pcrOptions {
  double distance_pr = 5;
  double seed_radius_pr = 5;
  double seed_share = 0.2;
  int neighbours = 30;
  int kept = 20;
  double tolerance_pr = 5;
  PoseScore score = PoseScore::Inliers;
  int refit_rounds = 20;
  int keep = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"distance_pr", "pr", "", "difference of distances below which two matches agree", above(0)},
          self.distance_pr);
    visit(OptionField{"seed_radius_pr", "pr", "", "distance of source points within which there is one seed", above(0)},
          self.seed_radius_pr);
    visit(OptionField{"seed_share", "", "", "of all matches, the most that are seeds", above_up_to(0, 1)},
          self.seed_share);
    visit(OptionField{"neighbours", "", "", "matches of a first consensus, its seed included", at_least(3)},
          self.neighbours);
    visit(OptionField{"kept", "", "", "of these, the matches that its pose is fitted to", at_least(3)}, self.kept);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"score", "", "", "what a pose is worth"}, self.score);
    visit(OptionField{"refit_rounds", "", "", "weighted fits from the chosen pose", at_least(0)}, self.refit_rounds);
    visit(OptionField{"keep", "", "", "poses returned beside the chosen one", at_least(0)}, self.keep);
  }
};

/// Second-order spatial compatibility (SC2-PCR): the best pose of the small sets of matches that agree with many of the same
/// matches as a seed does.
///
///   D_ij = | |p_i - p_j| - |p'_i - p'_j| |    S_ij = max(0, 1 - (D_ij/d)^2)    H_ij = [D_ij < d]    h_ij = [D_ij < d/2]
///
/// seeds     v from 10 rounds v <- S v / |S v|, from equal entries; the matches with no larger v within `seed_radius` in the source,
///           by v, and at most max(1, floor(share M)) of them.
/// first     seed s and the matches of the largest W_sj = H_sj sum_k h_sk h_kj > 0; equal ones by the smaller D_sj.
/// second    the seed and those of them that the most of them agree with (sum of H); equal ones by W, then D.
/// pose      weighted fit (weighted_fit.h), the weights from 10 rounds w <- S w over the second set, S without its diagonal.
///
/// These are the poses among which PoseChoice chooses.
/// Source    [chen2022sc2pcr], its program for the steps within a seed; `score = fs` [chen2023sc2pcr].
/// Reads     source_points, target_points, resolution; feature_distance, if it is there, for fs.
/// Returns   selected, the pose, and `keep` runners-up.
/// Cost      O(M^2) for each of 10 rounds, O(share M^3 / 64) at most; 4 M^2 bytes. Deterministic.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   All rows are used, none is drawn; the answer is that of the set of rows (canonical_order.h). Exactly 10 rounds: the
///           limit of v has no seeds outside the heaviest part of the graph. v counts to 24 bits, so that rounding settles no
///           tie; equal neighbours: the first is the seed. Seeds are not filled up with other matches. A set of fewer than 3,
///           or without a model, gives no pose. The refit has the tolerance of the choice. With fs, poses are made of all rows, also
///           of several of one source point.
GroupingResult group_by_sc2pcr(const CorrespondenceSet& matches, const Sc2pcrOptions& options = {});
double working_memory(int matches, const Sc2pcrOptions& options);

}  // namespace corral
