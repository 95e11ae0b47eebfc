// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

struct TcfOptions {
  double length_pr = 3;
  double tolerance_pr = 5;
  int max_trials = 10000;
  int sample = 2000;
  PoseScore score = PoseScore::Inliers;
  int keep = 0;
  std::uint64_t seed = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"length_pr", "pr", "",
                      "t: twice this is how much two lengths may differ, once how far a match may be off", above(0)},
          self.length_pr);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with the final pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"max_trials", "", "", "most trials of each stage", at_least(1)}, self.max_trials);
    visit(OptionField{"sample", "", "", "rows beyond which 500 of them stand for all where pairs are counted",
                      at_least(500)},
          self.sample);
    visit(OptionField{"score", "", "", "what makes a pose the best"}, self.score);
    visit(OptionField{"keep", "", "", "poses returned beside the chosen one", at_least(0)}, self.keep);
    visit(OptionField{"seed", "", "", "start of the random stream", at_least(0)}, self.seed);
  }
};

/// Two-stage consensus filtering (TCF): random consensus on one match, on two, on three, then a robust fit.
///
///   F_ij = [ D_ij < 2t ],  D_ij = | |p_i - p_j| - |p'_i - p'_j| |;   size(I) = ceil(sqrt(sum of F over I x I))
///   one      r at random: I = { i : D_ri < 2t }; up to 50 times: keep the size(I) rows of the largest sums in I, until
///            fewer than 5 leave. A = the I of the largest size.
///   two      a, b at random in A with F_ab: I = the k with F_ak, F_bk and an angle at k that differs by less than
///            asin(2t / |p_a - p_k|) + asin(2t / |p_b - p_k|). B = the I of the largest size.
///   three    a triple at random in B: its pose. The best by `score` at tolerance t; from trial 50 on each new best adds 50 fits
///            to 21 of its matches.
///   fit      on the matches of B below t: w = alpha^2 / (alpha^2 + e^2), those beyond 3 alpha leave, alpha /= 1.3, from the largest
///            residual of the first fit down to 1 pr, or until the weighted cost changes by less than 1e-4 of itself.
///   selected = { c : e(c, T) < tolerance }
///
/// Trials of a stage of s matches: ln 0.01 / ln(1 - w^s), w the share of the largest consensus so far.
/// Source    [shi2024tcf].
/// Reads     source_points, target_points, resolution.
/// Returns   selected, the pose, runners-up of the third stage if asked for.
/// Cost      O(M) for each trial and O(sample^2) at most for its counts; O(M) memory. A function of the set of rows for a seed.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   Every draw is a trial, also one that gives nothing. Ties go to the larger sum of F, then to the first. Beyond
///           `sample` rows sums are taken against 500 rows at even steps and scaled. A triple needs an area above 1e-3 pr^2 on
///           either side. The floor of alpha is 1 pr and the cost is compared with itself (the original's limits are lengths
///           in its unit). A stage that leaves fewer than 3 rows: nothing.
GroupingResult group_by_tcf(const CorrespondenceSet& matches, const TcfOptions& options = {});
double working_memory(int matches, const TcfOptions& options);

}  // namespace corral
