// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/surface_coverage.h"

#include <algorithm>
#include <cmath>

namespace corral {
namespace {

/// Rows at even steps.
Points some_of(const Points& rows, int most) {
  const Eigen::Index count = std::min<Eigen::Index>(rows.rows(), most);
  Points some(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) some.row(i) = rows.row(i * rows.rows() / count);
  return some;
}

}  // namespace

SurfaceCoverage::Side::Side(const OrientedPoints& surface, int most_asked)
    : normals(surface.normals),
      asked_points(some_of(surface.points, most_asked)),
      asked_normals(some_of(surface.normals, most_asked)),
      tree(surface.points),
      points(surface.points) {}

SurfaceCoverage::SurfaceCoverage(const OrientedPoints& source, const OrientedPoints& target, int most_asked)
    : source_(source, most_asked), target_(target, most_asked) {}

double SurfaceCoverage::operator()(const RigidTransform& target_from_source, double reach) const {
  return (covered(source_, target_, target_from_source, reach) +
          covered(target_, source_, target_from_source.inverse(), reach)) /
         2;
}

double SurfaceCoverage::covered(const Side& from, const Side& onto, const RigidTransform& onto_from_from,
                                double reach) {
  const Points moved = onto_from_from.apply(from.asked_points);
  NearestTracker tracker(onto.tree);
  const Indices& nearest = tracker.nearest(moved, reach);
  double sum = 0;
  for (Eigen::Index i = 0; i < moved.rows(); ++i) {
    const int row = nearest[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    const Eigen::Vector3d normal = onto_from_from.rotation * from.asked_normals.row(i).transpose();
    const double distance = (moved.row(i) - onto.points.row(row)).norm();
    sum += std::max(0.0, 1 - distance / reach) * std::abs(normal.dot(onto.normals.row(row)));
  }
  return moved.rows() > 0 ? sum / static_cast<double>(moved.rows()) : 0;
}

}  // namespace corral
