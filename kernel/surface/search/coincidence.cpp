// SPDX-License-Identifier: MIT
#include "kernel/surface/search/coincidence.h"

#include <algorithm>
#include <vector>

namespace corral {

Coincidence coincidence(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                          const RigidTransform& surface_from_points, double resolution) {
  const Points moved = surface_from_points.apply(points);
  NearestTracker tracker(tree_of_surface);
  const Indices& nearest = tracker.nearest(moved, 2 * resolution);
  std::vector<double> distances;
  for (std::size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i] >= 0)
      distances.push_back((moved.row(static_cast<Eigen::Index>(i)) - surface.row(nearest[i])).norm());
  Coincidence fit;
  if (distances.empty()) return fit;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  fit.share = static_cast<double>(distances.size()) / static_cast<double>(points.rows());
  fit.median_pr = *middle / resolution;
  return fit;
}

}  // namespace corral
