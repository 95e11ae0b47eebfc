// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/rigid_transform.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// How well points lie on a surface, measured where the two overlap: some of the points may have no counterpart.
struct Coincidence {
  double share = 0;                 ///< of the points, those with a vertex of the surface within 2 pr, 0 .. 1
  double near_share = 0;            ///< the same within 4 pr
  std::optional<double> median_pr;  ///< of the distances up to 2 pr; absent if there is none
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of the moved points within 4 pr of the surface

  /// Surfaces that coincide have a median well below 1 pr; those that only cross have one above, because the distances are
  /// then uniform over 0 .. 2 pr. The share excludes contacts by chance.
  bool is_good() const { return share >= 0.02 && median_pr && *median_pr <= 1; }
};

/// Of the moved points to the vertices of the surface. If the points are those of the coarser surface, the distances do not
/// grow with a difference in density. `resolution`: mesh units per pr.
Coincidence coincidence(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                        const RigidTransform& surface_from_points, double resolution);

/// How much better points lie on a surface than after a small turn: Coincidence::share over its mean after six turns by 20
/// degrees, to both sides about each axis through `middle`; 0.005 is added to the mean. About 1 where surfaces cross by
/// chance (below 1.6 for wrong poses of real scans), and 2 to 15 where one lies on the other, unless it is a plane or a
/// sphere.
double distinctness(const Coincidence& found, const Points& points, const PointTree& tree_of_surface,
                    const RigidTransform& surface_from_points, double resolution);

/// A surface with its unit normals, a row each.
struct OrientedPoints {
  const Points &points, &normals;
};

/// Of the moved points with a vertex of the surface within 2 pr, the share whose normal and that of the vertex point to
/// opposite sides, 0 .. 1: near 0 where both surfaces have the same side, near 1 where one of them is turned. Absent if there
/// is no such point.
std::optional<double> opposed_share(const OrientedPoints& source, const OrientedPoints& target,
                                    const PointTree& tree_of_target, const RigidTransform& target_from_source,
                                    double resolution);

}  // namespace corral
