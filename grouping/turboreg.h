// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

struct TurboregOptions {
  double edge_pr = 2;
  double min_length_pr = 10;
  int pivots = 1000;
  double tolerance_pr = 5;
  PoseScore score = PoseScore::Inliers;
  int refit_rounds = 20;
  int keep = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"edge_pr", "pr", "", "difference of distances below which two matches are an edge", above(0)},
          self.edge_pr);
    visit(OptionField{"min_length_pr", "pr", "", "sum of the two lengths above which they are an edge", at_least(0)},
          self.min_length_pr);
    visit(OptionField{"pivots", "", "", "edges that triangles are made of", at_least(1)}, self.pivots);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"score", "", "", "what a pose is worth"}, self.score);
    visit(OptionField{"refit_rounds", "", "", "weighted fits from the chosen pose", at_least(0)}, self.refit_rounds);
    visit(OptionField{"keep", "", "", "poses returned beside the chosen one", at_least(0)}, self.keep);
  }
};

/// TurboReg: the best pose of the triangles on those edges that have the most common neighbours.
///
///   D_ij = | |p_i - p_j| - |p'_i - p'_j| |       C_ij = [ D_ij < edge  and  |p_i - p_j| + |p'_i - p'_j| > min_length ]
///   W_ij = C_ij sum_k C_ik C_kj
///
/// Pivots are the edges with the largest W_ij > 0; equal ones by the smaller D_ij. The third corners of a pivot are the two
/// common neighbours k of the largest W_ij + W_ik + W_jk; equal ones by the smaller max(D_ik, D_jk). The triangles give
/// the poses among which PoseChoice chooses.
///
/// Source    [yan2025turboreg]; the form is that of its program.
/// Reads     source_points, target_points, resolution.
/// Returns   selected, the pose, and `keep` runners-up.
/// Cost      O(M^2) for the edges. O(s M / 64) for each row whose edges can be pivots and each end of a pivot, s the smaller of its number of
///           neighbours and of what they differ in from the well connected rows (common_neighbors.h). M^2 / 8 bytes. Deterministic.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   All rows are used, not the first thousands, and a third corner may lie before the edge in the table: the answer is that
///           of the set of rows (canonical_order.h). A triangle counts once. A triangle of at most 1e-3 pr^2 on either side
///           gives no pose. No indoor threshold is taken over: edge_pr is wider than that of its program (0.4 pr), for keypoints.
GroupingResult group_by_turboreg(const CorrespondenceSet& matches, const TurboregOptions& options = {});
double working_memory(int matches, const TurboregOptions& options);

}  // namespace corral
