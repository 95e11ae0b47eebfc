// SPDX-License-Identifier: MIT
#include "apps/pair/confidence_signals.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>

#include "grouping/pose/pose_score.h"

namespace corral {
namespace {

constexpr double kOtherPr = 10;

/// The fewer distinct points of the two sides of these rows.
int distinct(const CorrespondenceSet& matches, const Indices& rows) {
  std::set<std::tuple<double, double, double>> source, target;
  for (const int row : rows) {
    source.insert({matches.source_points(row, 0), matches.source_points(row, 1), matches.source_points(row, 2)});
    target.insert({matches.target_points(row, 0), matches.target_points(row, 1), matches.target_points(row, 2)});
  }
  return static_cast<int>(std::min(source.size(), target.size()));
}

/// Root mean square displacement of the matched points that the errors of the fit to these rows make likely, pr.
double uncertainty_pr(const CorrespondenceSet& matches, const RigidTransform& pose, const Indices& rows, int m) {
  constexpr double kUnknown = 100;
  if (m < 4) return kUnknown;
  const Points moved = pose.apply(matches.source_points) / matches.resolution;
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  for (const int row : rows) centre += moved.row(row) / static_cast<double>(rows.size());
  const auto jacobian = [&](int row) {
    const Eigen::RowVector3d x = moved.row(row) - centre;
    Eigen::Matrix<double, 3, 6> j;
    j << 0, x.z(), -x.y(), 1, 0, 0, -x.z(), 0, x.x(), 0, 1, 0, x.y(), -x.x(), 0, 0, 0, 1;
    return j;
  };
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  double squares = 0;
  for (const int row : rows) {
    const auto j = jacobian(row);
    normal += j.transpose() * j;
    squares += (moved.row(row) - matches.target_points.row(row) / matches.resolution).squaredNorm();
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, 6, 6>> solver(normal);
  if (!solver.isInvertible()) return kUnknown;
  const Eigen::Matrix<double, 6, 6> covariance = squares / std::max(1, 3 * m - 6) * solver.inverse();
  double sum = 0;
  for (int row = 0; row < matches.size(); ++row) {
    const auto j = jacobian(row);
    sum += (j * covariance * j.transpose()).trace();
  }
  const double found = std::sqrt(std::max(0.0, sum / matches.size()));
  return std::isfinite(found) ? std::min(found, kUnknown) : kUnknown;
}

/// The most matches outside `rows` that agree with one pose far from this one.
int support_of_others(const CorrespondenceSet& matches, const RigidTransform& pose, const Indices& rows,
                      const std::vector<RigidTransform>& others) {
  int most = 0;
  for (const RigidTransform& other : others) {
    if (!(pose_distance_pr(matches, other, pose) > kOtherPr)) continue;
    Indices apart;
    const Indices theirs = agreeing_rows(matches, other);
    std::set_difference(theirs.begin(), theirs.end(), rows.begin(), rows.end(), std::back_inserter(apart));
    most = std::max(most, static_cast<int>(apart.size()));
  }
  return most;
}

}  // namespace

Indices agreeing_rows(const CorrespondenceSet& matches, const RigidTransform& pose) {
  std::vector<double> residuals;
  measure_residuals(matches, pose, residuals);
  return rows_within(residuals, kAgreeingPr * matches.resolution);
}

double table_score(const CorrespondenceSet& matches, const RigidTransform& pose) {
  std::vector<double> residuals;
  measure_residuals(matches, pose, residuals);
  const double tolerance = kAgreeingPr * matches.resolution;
  double sum = 0;
  for (const double residual : residuals)
    if (residual < tolerance) sum += 1 - residual * residual / (tolerance * tolerance);
  return matches.size() > 0 ? sum / matches.size() : 0;
}

double pose_distance_pr(const CorrespondenceSet& matches, const RigidTransform& a, const RigidTransform& b) {
  return (a.apply(matches.source_points) - b.apply(matches.source_points)).rowwise().norm().mean() / matches.resolution;
}

ConfidenceSignals confidence_signals(const CorrespondenceSet& matches, const RigidTransform& pose,
                                     const OtherPoses& others, const SurfaceEvidence& surfaces) {
  const Indices rows = agreeing_rows(matches, pose);
  const int n = matches.size(), m = distinct(matches, rows);
  const int m2 = support_of_others(matches, pose, rows, others.all);
  const auto agreeing = std::count_if(others.own.begin(), others.own.end(), [&](const RigidTransform& own) {
    return pose_distance_pr(matches, own, pose) < kOtherPr;
  });
  return {std::log(1.0 + m),
          std::log((m + 1.0) / (n - m + 1.0)),
          std::log((m + 1.0) / (m2 + 1.0)),
          -std::log(0.01 + uncertainty_pr(matches, pose, rows, m)),
          static_cast<double>(agreeing) / std::max(others.groupers, 1),
          surfaces.overlap,
          0 - surfaces.rms_pr / 4,
          0 - surfaces.in_front,
          0 - std::log(1 + surfaces.moved_pr)};
}

}  // namespace corral
