// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/rigid_transform.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// How well points lie on a surface, measured where the two overlap: some of the points may have no counterpart.
struct Coincidence {
  double share = 0;                 ///< of the points, those with a vertex of the surface within 2 pr, 0 .. 1
  std::optional<double> median_pr;  ///< of their distances to it; absent if there is none

  /// Surfaces that coincide have a median well below 1 pr; those that only cross have one above, because the distances are
  /// then uniform over 0 .. 2 pr. The share excludes contacts by chance.
  bool is_good() const { return share >= 0.02 && median_pr && *median_pr <= 1; }
};

/// Of the moved points to the vertices of the surface. If the points are those of the coarser surface, the distances do not
/// grow with a difference in density. `resolution`: mesh units per pr.
Coincidence coincidence(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                        const RigidTransform& surface_from_points, double resolution);

}  // namespace corral
