// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <random>

#include "kernel/random.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {
namespace {

/// Columns are the three points of a triple.
Eigen::Matrix3d corners(const Points& points, const Indices& triple) { return points(triple, Eigen::all).transpose(); }

bool is_flat(const Eigen::Matrix3d& triangle, double resolution) {
  const Eigen::Vector3d one = triangle.col(1) - triangle.col(0), other = triangle.col(2) - triangle.col(0);
  return one.cross(other).norm() / 2 <= 1e-3 * resolution * resolution;
}

/// Rows that the motion through three rows carries to within the tolerance; none where the three fix no motion.
Indices rows_agreeing_with(const CorrespondenceSet& matches, const Indices& triple, double tolerance_pr) {
  const Eigen::Matrix3d source = corners(matches.source_points, triple),
                        target = corners(matches.target_points, triple);
  if (is_flat(source, matches.resolution) || is_flat(target, matches.resolution)) return {};
  const Eigen::Vector3d source_mean = source.rowwise().mean(), target_mean = target.rowwise().mean();
  const Eigen::Matrix3d h = (source.colwise() - source_mean) * (target.colwise() - target_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()(1) <= 1e-6 * svd.singularValues()(0)) return {};
  const double sign = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d turn = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  Indices agreeing;
  for (int i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d from_mean = matches.source_points.row(i).transpose() - source_mean;
    const Eigen::Vector3d to_mean = matches.target_points.row(i).transpose() - target_mean;
    if ((turn * from_mean - to_mean).norm() < tolerance_pr * matches.resolution) agreeing.push_back(i);
  }
  return agreeing;
}

/// Three rows without replacement: each draw is a place in the ascending list of those left.
Indices draw_triple(RandomStream& random, int rows) {
  Indices left, triple;
  for (int row = 0; row < rows; ++row) left.push_back(row);
  for (int draw = 0; draw < 3; ++draw) {
    const auto place = left.begin() + static_cast<std::ptrdiff_t>(random.below(left.size()));
    triple.push_back(*place);
    left.erase(place);
  }
  return triple;
}

}  // namespace

Selection ransac(const CorrespondenceSet& matches, const RansacOptions& options) {
  if (matches.size() < 3) return {};
  Indices best;
  RandomStream random(options.seed);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const Indices agreeing = rows_agreeing_with(matches, draw_triple(random, matches.size()), options.tolerance_pr);
    if (agreeing.size() > best.size()) best = agreeing;
  }
  return {best};
}

int ransac_count(const CorrespondenceSet& matches, int trials, double tolerance_pr, std::uint64_t seed) {
  if (matches.size() < 3) return 0;
  std::mt19937_64 engine(seed);
  const auto draw = [&] { return static_cast<int>(engine() % static_cast<std::uint64_t>(matches.size())); };
  std::size_t best = 0;
  for (int trial = 0; trial < trials;) {
    const int a = draw(), b = draw(), c = draw();
    if (a == b || b == c || a == c) continue;  // draw again
    best = std::max(best, rows_agreeing_with(matches, {a, b, c}, tolerance_pr).size());
    ++trial;
  }
  return static_cast<int>(best);
}

}  // namespace corral::reference
