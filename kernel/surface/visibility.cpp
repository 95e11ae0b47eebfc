// SPDX-License-Identifier: MIT
#include "kernel/surface/visibility.h"

namespace corral {

Points overlap_points(const Points& source, const PointIndex& target_index, const RigidTransform& target_from_source,
                      double threshold) {
  const Points moved = target_from_source.apply(source);
  Indices shared;
  for (Eigen::Index row = 0; row < source.rows(); ++row) {
    const auto nearest = target_index.nearest(moved.row(row).transpose(), 1);
    if (!nearest.empty() && nearest.front().squared_distance <= threshold * threshold)
      shared.push_back(static_cast<int>(row));
  }
  return source(shared, Eigen::all);
}

}  // namespace corral
