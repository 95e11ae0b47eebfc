// SPDX-License-Identifier: MIT
#include "kernel/surface/search/coincidence.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace corral {
namespace {

constexpr double kClosePr = 2, kNearPr = 4;
constexpr double kTurn_rad = 20 * EIGEN_PI / 180;
constexpr double kChance = 0.005;  // keeps a share of a few points from looking distinct

}  // namespace

Coincidence coincidence(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                        const RigidTransform& surface_from_points, double resolution) {
  const Points moved = surface_from_points.apply(points);
  NearestTracker tracker(tree_of_surface);
  const Indices& nearest = tracker.nearest(moved, kNearPr * resolution);
  Coincidence fit;
  std::vector<double> close;
  int near = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i] < 0) continue;
    const auto point = moved.row(static_cast<Eigen::Index>(i));
    const double distance = (point - surface.row(nearest[i])).norm();
    fit.middle += point.transpose();
    ++near;
    if (distance <= kClosePr * resolution) close.push_back(distance);
  }
  if (near == 0) return fit;
  fit.middle /= near;
  fit.near_share = near / static_cast<double>(points.rows());
  fit.share = static_cast<double>(close.size()) / static_cast<double>(points.rows());
  if (close.empty()) return fit;
  const auto median = close.begin() + static_cast<std::ptrdiff_t>(close.size() / 2);
  std::nth_element(close.begin(), median, close.end());
  fit.median_pr = *median / resolution;
  return fit;
}

double distinctness(const Coincidence& found, const Points& points, const PointTree& tree_of_surface,
                    const RigidTransform& surface_from_points, double resolution) {
  double share = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-kTurn_rad, kTurn_rad}) {
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      const RigidTransform turned{turn, found.middle - turn * found.middle};
      NearestTracker tracker(tree_of_surface);
      const Indices& nearest = tracker.nearest((turned * surface_from_points).apply(points), kClosePr * resolution);
      share += static_cast<double>(nearest.size() -
                                   static_cast<std::size_t>(std::count(nearest.begin(), nearest.end(), -1))) /
               static_cast<double>(points.rows()) / 6;
    }
  return found.share / (share + kChance);
}

std::optional<double> opposed_share(const OrientedPoints& source, const OrientedPoints& target,
                                    const PointTree& tree_of_target, const RigidTransform& target_from_source,
                                    double resolution) {
  NearestTracker tracker(tree_of_target);
  const Indices& nearest = tracker.nearest(target_from_source.apply(source.points), kClosePr * resolution);
  const Points normals = source.normals * target_from_source.rotation.transpose();
  int close = 0, opposed = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i] < 0) continue;
    ++close;
    opposed += normals.row(static_cast<Eigen::Index>(i)).dot(target.normals.row(nearest[i])) < 0;
  }
  if (close == 0) return std::nullopt;
  return static_cast<double>(opposed) / close;
}

}  // namespace corral
