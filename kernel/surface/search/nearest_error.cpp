// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_error.h"

#include <limits>

namespace corral {

double nearest_error(const RigidTransform& estimate, const RigidTransform& truth, const Points& points,
                     const PointTree& tree) {
  constexpr Eigen::Index kMost = 2000;
  if (points.rows() == 0) return 0;
  const Eigen::Index step = (points.rows() + kMost - 1) / kMost;
  Points chosen((points.rows() + step - 1) / step, 3);
  for (Eigen::Index i = 0; i < chosen.rows(); ++i) chosen.row(i) = points.row(i * step);
  const Points placed = (estimate.inverse() * truth).apply(chosen);
  NearestTracker tracker(tree);
  const Indices& nearest = tracker.nearest(placed, std::numeric_limits<double>::infinity());
  double sum = 0;
  for (Eigen::Index i = 0; i < placed.rows(); ++i)
    sum += (placed.row(i) - points.row(nearest[static_cast<std::size_t>(i)])).norm();
  return sum / static_cast<double>(placed.rows());
}

}  // namespace corral
