// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "grouping/columns/filter.h"
#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"

namespace corral {

/// How a grouper chooses among its hypotheses.
struct PoseRule {
  PoseScore score = PoseScore::Inliers;
  double tolerance_pr = 5;  ///< tau
  int refit_rounds = 0;     ///< of refit() from the chosen pose
  int keep = 0;             ///< poses returned beside it
  bool first_wins = false;  ///< of equal scores the first offered is the best, not that of the larger mae
  int fewest = 3;           ///< rows below tau that a pose needs
};

/// Better poses by iterated weighted fits to the rows that agree with the last:
///
///   I = { e(T) < tau };  stop if |I| < 3 or I is unchanged;   T <- fit_weighted(I, 1 / (1 + (e/tau)^2))
///
/// at most `rounds` times. Returns the best of the poses visited, the given one included: by score, then by mae, then the first.
/// Source    [chen2022sc2pcr], which keeps the last pose visited.
RigidTransform refit(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                     const PoseScorer& scorer, double tolerance, int rounds);

/// The choice among poses that all groupers make which have many: by score, then by mae, then the first offered.
///
/// Fs judges the 50 best by Inliers in a second way. The rows of one source point are its candidates; each of the 50 is
/// refitted for one round on the row of the smallest feature distance of each point. A point is covered if a candidate of it is below
/// tau; its partner is the candidate of the smallest feature distance (without that column: of the smallest residual) among
/// those below 1.5 tau. With D the difference of the two lengths between covered points and between their partners,
///
///   fs = max_i | { j covered : D_ij < tau / 2 } |
///
/// Source    [chen2023sc2pcr].
class PoseChoice {
 public:
  /// `matches` must outlive it.
  PoseChoice(const CorrespondenceSet& matches, const PoseRule& rule);

  /// Bytes for so many rows and hypotheses.
  static double memory(int rows, double hypotheses, const PoseRule& rule);

  /// Whether every hypothesis must be offered: those that cannot be the best too.
  bool needs_all() const { return rule_.keep > 0 || rule_.score == PoseScore::Fs; }

  /// Above this score a hypothesis is the best so far; -1 before the first.
  double best_score() const { return best_ ? best_->score : -1; }

  /// Those of the best so far.
  const std::vector<double>& best_residuals() const { return best_residuals_; }

  /// The next hypothesis; says whether it is the best so far (by Fs: by Inliers). A pose that cannot be chosen is dropped as soon as floats are certain of it, unless `keep` or
  /// Fs need them all.
  bool offer(const RigidTransform& target_from_source);

  /// The chosen pose after refit(), the rows below tau of it, and the runners-up: of the other hypotheses in the order of the
  /// choice those whose mean displacement of the source points is above 10 pr from the chosen pose and from all before.
  /// Fewer than `fewest` rows below tau: nothing, no pose.
  GroupingResult finish();

 private:
  struct Judged {
    RigidTransform target_from_source;
    double score, mae;
  };
  static bool is_better(const Judged& a, const Judged& b) {
    return a.score != b.score ? a.score > b.score : a.mae > b.mae;
  }

  Judged judge(const RigidTransform& target_from_source);
  bool is_hopeless(const RigidTransform& target_from_source) const;
  void judge_by_distances();

  const CorrespondenceSet& matches_;
  const PoseRule rule_;
  const double tolerance_;
  const FilterTable table_;
  const PoseScorer scorer_, mae_;
  std::vector<double> residuals_, best_residuals_;
  std::optional<Judged> best_;
  std::vector<Judged> poses_;  ///< all, if they are needed
};

}  // namespace corral
