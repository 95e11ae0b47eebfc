// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/depth_image.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kMostCells = 1024;  // along a side

}  // namespace

DepthImage::DepthImage(const Points& view, double cell, const ViewOptions& options)
    : is_perspective_(!options.direction), cell_(cell) {
  require_positive("DepthImage", "cell", cell);
  if (view.rows() == 0) throw InvalidInput("DepthImage", "view", "no points", "one at least");
  const Eigen::Vector3d centre = view.colwise().mean().transpose();
  sensor_ = is_perspective_ ? options.sensor : centre;
  forward_ = options.direction.value_or(centre - options.sensor).stableNormalized();
  right_ = forward_.unitOrthogonal();
  up_ = right_.cross(forward_);
  distance_ = (centre - sensor_).dot(forward_);
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Eigen::Index row = 0; row < view.rows(); ++row) {
    const Place seen = place(view.row(row).transpose());
    if (!std::isfinite(seen.u + seen.v + seen.depth))
      throw InvalidInput("DepthImage", "vertex " + std::to_string(row), "not in front of the sensor", "in front of it");
    low = low.min(Eigen::Array2d(seen.u, seen.v));
    high = high.max(Eigen::Array2d(seen.u, seen.v));
  }
  const double larger = std::max(1.0, (high - low).maxCoeff() / (kMostCells - 3));
  cell_ *= larger;
  first_u_ = std::floor(low[0] / larger) - 1;
  first_v_ = std::floor(low[1] / larger) - 1;
  columns_ = static_cast<Eigen::Index>(std::floor(high[0] / larger) - first_u_) + 2;
  rows_ = static_cast<Eigen::Index>(std::floor(high[1] / larger) - first_v_) + 2;
  nearest_.setConstant(columns_, rows_, std::numeric_limits<double>::infinity());
  for (Eigen::Index row = 0; row < view.rows(); ++row) {
    const Place seen = place(view.row(row).transpose());
    double& depth = nearest_(static_cast<Eigen::Index>(std::floor(seen.u) - first_u_),
                             static_cast<Eigen::Index>(std::floor(seen.v) - first_v_));
    depth = std::min(depth, seen.depth);
  }
}

DepthImage::Place DepthImage::place(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d ray = point - sensor_;
  const double along = ray.dot(forward_);
  if (!is_perspective_) return {ray.dot(right_) / cell_, ray.dot(up_) / cell_, along};
  const double scale = along > 0 ? distance_ / along / cell_ : std::numeric_limits<double>::quiet_NaN();
  return {ray.dot(right_) * scale, ray.dot(up_) * scale, along > 0 ? ray.norm() : scale};
}

double DepthImage::share_in_front(const Points& points, double margin) const {
  int in_front = 0;
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Place seen = place(points.row(row).transpose());
    const double u = std::floor(seen.u) - first_u_, v = std::floor(seen.v) - first_v_;
    if (!(u >= 1 && v >= 1 && u < static_cast<double>(columns_ - 1) && v < static_cast<double>(rows_ - 1))) continue;
    const auto column = static_cast<Eigen::Index>(u), line = static_cast<Eigen::Index>(v);
    if (std::isfinite(nearest_(column, line)) &&
        seen.depth < nearest_.block(column - 1, line - 1, 3, 3).minCoeff() - margin)
      ++in_front;
  }
  return static_cast<double>(in_front) / static_cast<double>(points.rows());
}

}  // namespace corral
