// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

struct MacOptions {
  double gate = 0.99;
  int cliques_per_node = 1;
  int max_steps = 20000;
  PoseScore score = PoseScore::Mae;
  double tolerance_pr = 5;
  int refit_rounds = 20;
  int keep = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"gate", "", "", "compatibility above which two matches agree", OptionRange{0, 1, true, true}},
          self.gate);
    visit(
        OptionField{"cliques_per_node", "", "", "heaviest cliques through each match that propose a pose", at_least(1)},
        self.cliques_per_node);
    visit(OptionField{"max_steps", "", "",
                      "steps of a search for cliques before it starts again on half of the matches", at_least(1)},
          self.max_steps);
    visit(OptionField{"score", "", "", "what a pose is worth"}, self.score);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"refit_rounds", "", "", "weighted fits to the matches that agree, from the chosen pose",
                      at_least(0)},
          self.refit_rounds);
    visit(OptionField{"keep", "", "", "poses returned beside the chosen one", at_least(0)}, self.keep);
  }
};

/// Maximal cliques (MAC): the best pose of the heaviest maximal clique through each match.
///
///   G_ij = exp(-D_ij^2 / (2 (10 pr)^2)) where that is above the gate, else 0;   D_ij = | |p_i - p_j| - |p'_i - p'_j| |
///   W_ij = G_ij sum_k G_ik G_jk;   c_i = sum_{a<b} (W_ia W_ib W_ab)^(1/3) / (d_i (d_i - 1) / 2),  d_i neighbours in W
///
/// Where the matches are many and well connected, min(otsu, mean, total) > 3 and M > 50, those with c > f max(otsu, total) remain:
/// otsu the threshold of otsu_bins100_threshold(c), total the quotient of the sums of both parts of c, f the largest of 10, 9.95,
/// ..., 0.05 with f max(otsu, total) <= the 50th largest c, or 0. Of the maximal cliques of W of 3 matches or more, each
/// match names the heaviest that it is in: by the sum of W over its pairs, then by size, then the first in the order of lists
/// of rows in canonical order. fit_weighted() with equal weights makes a pose of each; choice, refit() and final set as
/// in PoseChoice, the cliques offered in that order.
/// max_steps  A search that exceeds it is given up and starts again on the half of its matches with the larger c, ties by
///           canonical order, as often as need be.
/// Source    [zhang2023mac]; gate of its data set U3M.
/// Reads     source_points, target_points, resolution; other columns settle ties.
/// Returns   selected, target_from_source, runner_up if `keep` asks for them; notes: `steps` of the last search, `cliques`
///           that it met, `hypotheses`, and `halvings` if there were any. Nothing without a pose, or with fewer than 3 rows.
/// Cost      O(M^2 + edges x neighbours) time; the search is exponential, bounded by max_steps and log2 M halvings. Up to
///           32 M^2 bytes where all matches agree, far less where few do.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   A clique is weighed when it is met and none is stored that no match names. The refit keeps the best pose that it
///           visits. A bound of steps instead of the memory of the machine; poses are fitted and compared in a fixed order.
GroupingResult group_by_mac(const CorrespondenceSet& matches, const MacOptions& options = {});
double working_memory(int matches, const MacOptions& options);

}  // namespace corral
