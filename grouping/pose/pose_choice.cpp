// SPDX-License-Identifier: MIT
#include "grouping/pose/pose_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "kernel/weighted_fit.h"

namespace corral {
namespace {

constexpr double kApartPr = 10;                 ///< mean displacement of poses that are not the same
constexpr std::size_t kJudgedByDistances = 50;  ///< hypotheses that Fs judges
constexpr double kPartnerReach = 1.5;           ///< of Fs, in tolerances

double mean_displacement(const Points& points, const RigidTransform& a, const RigidTransform& b) {
  return (a.apply(points) - b.apply(points)).rowwise().norm().mean();
}

/// One step of refit(): absent without a model.
std::optional<RigidTransform> fit_to_agreeing(const CorrespondenceSet& matches, const Indices& agreeing,
                                              const std::vector<double>& residuals, double tolerance) {
  std::vector<double> weights;
  for (const int row : agreeing) {
    const double e = residuals[static_cast<std::size_t>(row)] / tolerance;
    weights.push_back(1 / (1 + e * e));
  }
  return fit_weighted(matches, agreeing, weights);
}

/// The rows of each source point, by feature distance.
std::vector<Indices> candidates_of_points(const CorrespondenceSet& matches) {
  const Points& p = matches.source_points;
  const auto is_less = [&](int a, int b) {
    for (int axis = 0; axis < 3; ++axis)
      if (p(a, axis) != p(b, axis)) return p(a, axis) < p(b, axis);
    return false;
  };
  Indices order(static_cast<std::size_t>(matches.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), is_less);
  std::vector<Indices> points;
  for (const int row : order) {
    if (points.empty() || is_less(points.back().front(), row)) points.emplace_back();
    points.back().push_back(row);
  }
  const Eigen::VectorXd& d1 = matches.feature_distance;
  if (d1.size() > 0)
    for (Indices& rows : points)
      std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return d1(a) < d1(b); });
  return points;
}

/// Fs of one pose over the points and their candidates.
class DistanceJudge {
 public:
  DistanceJudge(const CorrespondenceSet& matches, double tolerance)
      : matches_(matches), tolerance_(tolerance), points_(candidates_of_points(matches)) {
    for (const Indices& rows : points_) nearest_.push_back(rows.front());
  }

  /// Refits the pose for one round and returns its score.
  double operator()(RigidTransform& pose) {
    measure_residuals(matches_, pose, residuals_);
    Indices agreeing;
    for (const int row : nearest_)
      if (residual(row) < tolerance_) agreeing.push_back(row);
    if (const auto better = fit_to_agreeing(matches_, agreeing, residuals_, tolerance_)) pose = *better;
    measure_residuals(matches_, pose, residuals_);
    return largest_consistent(partners());
  }

 private:
  double residual(int row) const { return residuals_[static_cast<std::size_t>(row)]; }

  /// The partner of each point that is covered.
  Indices partners() const {
    Indices found;
    for (const Indices& rows : points_) {
      if (std::none_of(rows.begin(), rows.end(), [&](int row) { return residual(row) < tolerance_; })) continue;
      const auto smallest =
          std::min_element(rows.begin(), rows.end(), [&](int a, int b) { return residual(a) < residual(b); });
      const auto nearest =
          std::find_if(rows.begin(), rows.end(), [&](int row) { return residual(row) < kPartnerReach * tolerance_; });
      found.push_back(matches_.feature_distance.size() > 0 ? *nearest : *smallest);
    }
    return found;
  }

  double largest_consistent(const Indices& rows) const {
    int largest = 0;
    for (const int i : rows) {
      int agreeing = 0;
      for (const int j : rows) {
        const PairDistances lengths = pair_distances(matches_, i, j);
        agreeing += std::abs(lengths.source - lengths.target) < tolerance_ / 2;
      }
      largest = std::max(largest, agreeing);
    }
    return largest;
  }

  const CorrespondenceSet& matches_;
  const double tolerance_;
  const std::vector<Indices> points_;
  Indices nearest_;  ///< the candidate of the smallest feature distance of each point
  std::vector<double> residuals_;
};

}  // namespace

RigidTransform refit(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                     const PoseScorer& scorer, double tolerance, int rounds) {
  const PoseScorer mae(matches, PoseScore::Mae, tolerance);
  RigidTransform pose = target_from_source, best = pose;
  std::vector<double> residuals;
  measure_residuals(matches, pose, residuals);
  double best_score = scorer(residuals), best_mae = mae(residuals);
  Indices last;
  for (int round = 0; round < rounds; ++round) {
    Indices agreeing = rows_within(residuals, tolerance);
    if (agreeing.size() < 3 || agreeing == last) break;
    const auto next = fit_to_agreeing(matches, agreeing, residuals, tolerance);
    if (!next) break;
    pose = *next;
    last = std::move(agreeing);
    measure_residuals(matches, pose, residuals);
    const double score = scorer(residuals), worth = mae(residuals);
    if (!(score > best_score || (score == best_score && worth > best_mae))) continue;
    best = pose, best_score = score, best_mae = worth;
  }
  return best;
}

PoseChoice::PoseChoice(const CorrespondenceSet& matches, const PoseRule& rule)
    : matches_(matches),
      rule_(rule),
      tolerance_(rule.tolerance_pr * matches.resolution),
      table_(matches),
      scorer_(matches, rule.score, tolerance_),
      mae_(matches, PoseScore::Mae, tolerance_) {}

double PoseChoice::memory(int rows, double hypotheses, const PoseRule& rule) {
  const bool needs_all = rule.keep > 0 || rule.score == PoseScore::Fs;
  const double points = rule.score == PoseScore::Fs ? 80.0 * rows : 0, moved = rule.keep > 0 ? 96.0 * rows : 0;
  return FilterTable::memory(rows) + PoseScorer::memory(rows) + 40.0 * rows + points + moved +
         (needs_all ? 3 * sizeof(Judged) * hypotheses : 0);
}

bool PoseChoice::offer(const RigidTransform& target_from_source) {
  if (!needs_all() && best_ && is_hopeless(target_from_source)) return false;
  const Judged judged = judge(target_from_source);
  if (needs_all()) poses_.push_back(judged);
  if (best_ && !is_better(judged, *best_)) return false;
  best_ = judged;
  best_residuals_ = residuals_;
  return true;
}

PoseChoice::Judged PoseChoice::judge(const RigidTransform& target_from_source) {
  measure_residuals(matches_, target_from_source, residuals_);
  return {target_from_source, scorer_(residuals_), rule_.first_wins ? 0 : mae_(residuals_)};
}

/// No score exceeds the number of rows that possibly agree.
bool PoseChoice::is_hopeless(const RigidTransform& target_from_source) const {
  const int hopeless = static_cast<int>(rule_.first_wins ? std::floor(best_->score) : std::ceil(best_->score) - 1);
  const PoseFilter pose(table_, target_from_source, tolerance_);
  return count_near(table_, pose, hopeless) <= hopeless;
}

void PoseChoice::judge_by_distances() {
  std::stable_sort(poses_.begin(), poses_.end(), is_better);
  poses_.resize(std::min(poses_.size(), kJudgedByDistances));
  DistanceJudge fs(matches_, tolerance_);
  for (Judged& pose : poses_) pose.score = fs(pose.target_from_source);
}

GroupingResult PoseChoice::finish() {
  if (!best_) return {};
  if (rule_.score == PoseScore::Fs) judge_by_distances();
  std::stable_sort(poses_.begin(), poses_.end(), is_better);
  const Judged& best = poses_.empty() ? *best_ : poses_.front();
  const RigidTransform chosen = refit(matches_, best.target_from_source, scorer_, tolerance_, rule_.refit_rounds);
  measure_residuals(matches_, chosen, residuals_);
  GroupingResult result;
  result.selected = rows_within(residuals_, tolerance_);
  if (static_cast<int>(result.selected.size()) < rule_.fewest) return {};
  result.target_from_source = chosen;
  for (const Judged& pose : poses_) {
    if (static_cast<int>(result.runner_up.size()) == rule_.keep) break;
    const auto is_near = [&](const RigidTransform& other) {
      return !(mean_displacement(matches_.source_points, pose.target_from_source, other) >
               kApartPr * matches_.resolution);
    };
    if (is_near(chosen) || std::any_of(result.runner_up.begin(), result.runner_up.end(),
                                       [&](const ScoredPose& taken) { return is_near(taken.target_from_source); }))
      continue;
    result.runner_up.push_back({pose.target_from_source, pose.score});
  }
  return result;
}

}  // namespace corral
