// SPDX-License-Identifier: MIT
#include "grouping/tcf.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/graph/consensus.h"
#include "grouping/pose/pose_choice.h"
#include "kernel/random.h"
#include "kernel/weighted_fit.h"

namespace corral {
namespace {

constexpr double kDegenerateAreaPr2 = 1e-3;
constexpr int kFewestLeaving = 5;    ///< of the first stage: fewer end it
constexpr int kMostReductions = 50;  ///< of the first stage
constexpr int kLocalTrial = 50, kLocalFits = 50;
constexpr std::size_t kLocalRows = 21;

/// Trials until one holds only matches of the consensus with a probability of 0.99.
int trials_needed(double share, int drawn, int most) {
  const double needed = std::log(0.01) / std::log1p(-std::pow(share, drawn));
  return needed < most ? static_cast<int>(std::ceil(needed)) : most;
}

class Filtering {
 public:
  Filtering(const CorrespondenceSet& matches, const TcfOptions& options)
      : matches_(matches),
        options_(options),
        t_(options.length_pr * matches.resolution),
        consensus_(matches, 2 * t_, options.sample),
        random_(options.seed) {}

  GroupingResult run() {
    const Indices one = by_one();
    const Indices two = one.size() < 3 ? Indices{} : by_two(one);
    if (two.size() < 3) return {};
    const CorrespondenceSet left = select_rows(matches_, two);
    GroupingResult result = by_three(left);
    if (!result.target_from_source) return {};
    result.target_from_source = robust_fit(left, result.selected, *result.target_from_source);
    std::vector<double> residuals;
    measure_residuals(matches_, *result.target_from_source, residuals);
    result.selected = rows_within(residuals, options_.tolerance_pr * matches_.resolution);
    if (result.selected.size() < 3) return {};
    return result;
  }

 private:
  /// The largest set by size, then by sum, then the first; and how many trials are left to do.
  struct Best {
    Indices rows;
    Consensus::Size size;
    bool is_beaten_by(const Consensus::Size& other) const {
      return other.rows != size.rows ? other.rows > size.rows : other.sum > size.sum;
    }
  };

  Indices by_one() {
    Best best;
    std::vector<char> tried(static_cast<std::size_t>(matches_.size()), 0);
    int trials = options_.max_trials;
    for (int trial = 0; trial < trials; ++trial) {
      const int seed = draw(matches_.size());
      if (std::exchange(tried[static_cast<std::size_t>(seed)], 1)) continue;
      Indices rows = consensus_.with(seed);
      if (static_cast<int>(rows.size()) < best.size.rows || consensus_.is_smaller(rows, best.size.rows)) continue;
      const Consensus::Size size = reduce(rows);
      if (!best.is_beaten_by(size)) continue;
      best = {std::move(rows), size};
      trials = std::min(trials, trials_needed(1.0 * size.rows / matches_.size(), 1, options_.max_trials));
    }
    return best.rows;
  }

  /// Keeps the rows that agree with most of the others.
  Consensus::Size reduce(Indices& rows) {
    Consensus::Size size = consensus_.measure(rows, sums_);
    for (int round = 0; round < kMostReductions; ++round) {
      const auto kept = static_cast<std::size_t>(size.rows);
      if (rows.size() - kept < kFewestLeaving) break;
      Indices order(rows.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return sums_[static_cast<std::size_t>(a)] > sums_[static_cast<std::size_t>(b)];
      });
      order.resize(kept);
      for (int& row : order) row = rows[static_cast<std::size_t>(row)];
      std::sort(order.begin(), order.end());
      rows = std::move(order);
      size = consensus_.measure(rows, sums_);
    }
    return size;
  }

  Indices by_two(const Indices& rows) {
    Best best;
    int trials = options_.max_trials;
    for (int trial = 0; trial < trials; ++trial) {
      const int a = rows[static_cast<std::size_t>(draw(static_cast<int>(rows.size())))],
                b = rows[static_cast<std::size_t>(draw(static_cast<int>(rows.size())))];
      if (a == b || !consensus_.agree(a, b)) continue;
      Indices common;
      for (const int k : rows)
        if (k == a || k == b || (consensus_.agree(a, k) && consensus_.agree(b, k) && has_same_angle(k, a, b)))
          common.push_back(k);
      if (static_cast<int>(common.size()) < best.size.rows || consensus_.is_smaller(common, best.size.rows)) continue;
      const Consensus::Size size = consensus_.measure(common, sums_);
      if (!best.is_beaten_by(size)) continue;
      best = {std::move(common), size};
      trials =
          std::min(trials, trials_needed(1.0 * size.rows / static_cast<double>(rows.size()), 2, options_.max_trials));
    }
    return best.rows;
  }

  /// The angles at k between the directions to a and b differ by no more than points that are off by 2t allow.
  bool has_same_angle(int k, int a, int b) const {
    const auto slack = [&](int other) {
      const double length = point_distance(matches_.source_points, k, other);
      return length > 0 ? std::asin(std::min(0.9999, 2 * t_ / length)) : std::asin(0.9999);
    };
    return std::abs(angle(matches_.source_points, k, a, b) - angle(matches_.target_points, k, a, b)) <
           slack(a) + slack(b);
  }
  static double angle(const Points& points, int k, int a, int b) {
    const Eigen::Vector3d x = points.row(a) - points.row(k), y = points.row(b) - points.row(k);
    return std::atan2(x.cross(y).norm(), x.dot(y));
  }

  GroupingResult by_three(const CorrespondenceSet& left) {
    PoseRule rule;
    rule.score = options_.score;
    rule.tolerance_pr = options_.length_pr;
    rule.keep = options_.keep;
    PoseChoice choice(left, rule);
    const int rows = left.size();
    int trials = options_.max_trials;
    const auto shorten = [&](const RigidTransform& pose) {
      measure_residuals(left, pose, residuals_);
      const Indices agreeing = rows_within(residuals_, t_);
      trials =
          std::min(trials, trials_needed(1.0 * static_cast<double>(agreeing.size()) / rows, 3, options_.max_trials));
      return agreeing;
    };
    for (int trial = 0; trial < trials; ++trial) {
      const auto pose = pose_of({draw(rows), draw(rows), draw(rows)}, left);
      if (!pose || !choice.offer(*pose)) continue;
      Indices agreeing = shorten(*pose);
      if (trial < kLocalTrial || agreeing.size() < 3) continue;
      for (int fit = 0; fit < kLocalFits; ++fit) {
        const auto local = fit_to_some(left, agreeing);
        if (local && choice.offer(*local)) shorten(*local);
      }
    }
    return choice.finish();
  }

  static std::optional<RigidTransform> pose_of(const Indices& triple, const CorrespondenceSet& left) {
    if (triple[0] == triple[1] || triple[0] == triple[2] || triple[1] == triple[2]) return std::nullopt;
    for (const Points* points : {&left.source_points, &left.target_points})
      if (!(triangle_area(points->row(triple[0]), points->row(triple[1]), points->row(triple[2])) >
            kDegenerateAreaPr2 * left.resolution * left.resolution))
        return std::nullopt;
    return fit_rigid_transform(left, triple);
  }

  /// To 21 of the rows, drawn without return.
  std::optional<RigidTransform> fit_to_some(const CorrespondenceSet& left, Indices& rows) {
    const std::size_t count = std::min(rows.size(), kLocalRows);
    for (std::size_t i = 0; i < count; ++i)
      std::swap(rows[i], rows[i + static_cast<std::size_t>(draw(static_cast<int>(rows.size() - i)))]);
    const Indices some(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
    return fit_weighted(left, some, std::vector<double>(count, 1));
  }

  /// Ends with the last fit that there is a model for.
  static RigidTransform robust_fit(const CorrespondenceSet& left, Indices rows, const RigidTransform& start) {
    std::vector<double> weights(rows.size(), 1), residuals;
    RigidTransform pose = start;
    double alpha = 0, last_cost = 0;
    for (int round = 0; round <= 100; ++round) {
      const auto fit = fit_weighted(left, rows, weights);
      if (!fit) break;
      pose = *fit;
      measure_residuals(left, pose, residuals);
      double largest = 0, cost = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double e = residuals[static_cast<std::size_t>(rows[i])];
        largest = std::max(largest, e);
        cost += weights[i] * e * e;
      }
      alpha = round == 0 ? largest : alpha / 1.3;
      if (!(alpha >= left.resolution) || (round > 0 && std::abs(last_cost - cost) < 1e-4 * last_cost)) break;
      last_cost = cost;
      rows.erase(std::remove_if(rows.begin(), rows.end(),
                                [&](int row) { return residuals[static_cast<std::size_t>(row)] > 3 * alpha; }),
                 rows.end());
      weights.clear();
      for (const int row : rows) {
        const double e = residuals[static_cast<std::size_t>(row)];
        weights.push_back(alpha * alpha / (alpha * alpha + e * e));
      }
    }
    return pose;
  }

  int draw(int count) { return static_cast<int>(random_.below(static_cast<std::uint64_t>(count))); }

  const CorrespondenceSet& matches_;
  const TcfOptions& options_;
  const double t_;
  const Consensus consensus_;
  RandomStream random_;
  Indices sums_;
  std::vector<double> residuals_;
};

/// Only the points, so that tables of some rows are small.
CorrespondenceSet points_of(const CorrespondenceSet& matches) {
  CorrespondenceSet points;
  points.source_points = matches.source_points;
  points.target_points = matches.target_points;
  points.resolution = matches.resolution;
  return points;
}

}  // namespace

GroupingResult group_by_tcf(const CorrespondenceSet& matches, const TcfOptions& options) {
  validate_options(options, "tcf");
  matches.validate();
  if (matches.size() < 3) return {};
  return group_in_canonical_order(points_of(matches),
                                  [&](const CorrespondenceSet& sorted) { return Filtering(sorted, options).run(); });
}

double working_memory(int matches, const TcfOptions& options) {
  const int counted = std::min(matches, options.sample);
  PoseRule rule;
  rule.score = options.score;
  rule.keep = options.keep;
  // The points twice, sets of rows, what is left for the third stage.
  return 220.0 * matches + Consensus::memory(counted) + PoseChoice::memory(matches, options.max_trials * 2.0, rule);
}

}  // namespace corral
