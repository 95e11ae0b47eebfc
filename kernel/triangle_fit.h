// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/columns.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Triangles that are fitted together, one in every lane.
struct LaneTriangles {
  double numbers[3][3][kLanes];  ///< corner, axis, lane

  template <class Rows>
  void set(int lane, const Points& points, const Rows& rows) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis) numbers[corner][axis][lane] = points(rows[corner], axis);
  }
};

/// Their rigid motions q = R p + t.
struct LaneMotions {
  double numbers[13][kLanes];  ///< the rotation by rows, the translation, 1 if usable; by lane

  /// Not of a degenerate triangle, whose motion means nothing.
  bool is_usable(int lane) const { return numbers[12][lane] > 0; }
  RigidTransform get(int lane) const {
    RigidTransform motion;
    for (int i = 0; i < 9; ++i) motion.rotation(i / 3, i % 3) = numbers[i][lane];
    for (int i = 0; i < 3; ++i) motion.translation(i) = numbers[9 + i][lane];
    return motion;
  }
};

/// Least-squares rigid motion of one triangle to another: the result of fit_rigid_transform() in closed form.
///
/// The best motion lays plane on plane, normal on normal, centroid on centroid. In the planes, with corners P_i and Q_i
/// about their centroids and M = sum P_i Q_i^T, what is left is one angle: (cos, sin) ~ (M11 + M22, M12 - M21). Since
/// det M = 4/3 area area' >= 0, no mirrored motion is better. The singular values of M have the sum |(cos, sin)| and the
/// product det M.
///
/// Degenerate: an area of at most `smallest_area` on either side, the second singular value at most 1e-6 of the first, or
/// anything that is not finite.
/// Source    [kabsch1976solution], specialised.
/// Plain form  fit_rigid_transform() of the three corners.
void fit_triangles(const LaneTriangles& source, const LaneTriangles& target, double smallest_area,
                   LaneMotions& motions);

}  // namespace corral
