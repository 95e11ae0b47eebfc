// SPDX-License-Identifier: MIT
#include "grouping/ransac.h"

#include <array>

#include "kernel/random.h"

namespace corral {
namespace {

/// Smallest usable area of a sampled triangle in pr^2; below it the pose is decided by noise.
constexpr double kDegenerateAreaPr2 = 1e-3;

using Triple = std::array<int, 3>;

/// Three distinct rows, every ordered triple equally likely.
Triple draw_triple(RandomStream& random, int rows) {
  const auto count = static_cast<std::uint64_t>(rows);
  const int first = static_cast<int>(random.below(count));
  int second = static_cast<int>(random.below(count - 1));
  second += second >= first;
  int third = static_cast<int>(random.below(count - 2));
  third += third >= std::min(first, second);
  third += third >= std::max(first, second);
  return {first, second, third};
}

class Consensus {
 public:
  Consensus(const CorrespondenceSet& matches, double tolerance)
      : matches_(matches),
        squared_tolerance_(tolerance * tolerance),
        degenerate_area_(kDegenerateAreaPr2 * matches.resolution * matches.resolution),
        squared_residuals_(matches.size()) {}

  /// The pose through a triple; absent if the triple is degenerate.
  std::optional<RigidTransform> fit(const Triple& rows) const {
    if (is_degenerate(matches_.source_points, rows) || is_degenerate(matches_.target_points, rows)) return std::nullopt;
    return fit_rigid_transform(matches_.source_points(rows, Eigen::all), matches_.target_points(rows, Eigen::all));
  }

  int count(const RigidTransform& pose) {
    measure(pose);
    return static_cast<int>((squared_residuals_ < squared_tolerance_).count());
  }

  Indices agreeing(const RigidTransform& pose) {
    measure(pose);
    Indices rows;
    for (int row = 0; row < matches_.size(); ++row)
      if (squared_residuals_(row) < squared_tolerance_) rows.push_back(row);
    return rows;
  }

 private:
  bool is_degenerate(const Points& points, const Triple& rows) const {
    return !(triangle_area(points.row(rows[0]), points.row(rows[1]), points.row(rows[2])) > degenerate_area_);
  }

  void measure(const RigidTransform& pose) {
    const auto p = matches_.source_points.array();
    const auto q = matches_.target_points.array();
    const Eigen::Matrix3d& r = pose.rotation;
    const Eigen::Vector3d& t = pose.translation;
    squared_residuals_ = (r(0, 0) * p.col(0) + r(0, 1) * p.col(1) + r(0, 2) * p.col(2) + t(0) - q.col(0)).square() +
                         (r(1, 0) * p.col(0) + r(1, 1) * p.col(1) + r(1, 2) * p.col(2) + t(1) - q.col(1)).square() +
                         (r(2, 0) * p.col(0) + r(2, 1) * p.col(1) + r(2, 2) * p.col(2) + t(2) - q.col(2)).square();
  }

  const CorrespondenceSet& matches_;
  const double squared_tolerance_;
  const double degenerate_area_;
  Eigen::ArrayXd squared_residuals_;
};

}  // namespace

GroupingResult group_by_ransac(const CorrespondenceSet& matches, const RansacOptions& options) {
  validate_options(options, "ransac");
  matches.validate();
  GroupingResult result;
  if (matches.size() < 3) return result;

  RandomStream random(options.seed);
  Consensus consensus(matches, options.tolerance_pr * matches.resolution);
  int best_count = 0;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const auto pose = consensus.fit(draw_triple(random, matches.size()));
    if (!pose) continue;
    const int count = consensus.count(*pose);
    if (count > best_count) best_count = count, result.target_from_source = pose;
  }
  if (result.target_from_source) result.selected = consensus.agreeing(*result.target_from_source);
  return result;
}

}  // namespace corral
