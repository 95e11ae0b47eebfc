// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/types.h"

namespace corral {

/// The smallest box that holds some points, in their units.
struct BoundingBox {
  Eigen::RowVector3d low = Eigen::RowVector3d::Zero(), high = Eigen::RowVector3d::Zero();

  Eigen::RowVector3d middle() const { return 0.5 * low + 0.5 * high; }
  double diagonal() const { return (high - low).norm(); }
  double longest_side() const { return (high - low).maxCoeff(); }
};

/// The least and the largest of some finite numbers, at least one.
struct Extent {
  double low, high;
};
/// Plain form  tests/support/reference/columns.h
Extent extent_of(const double* numbers, Eigen::Index count);

/// For no points: a box of size zero at the origin. The points must be finite.
BoundingBox bounding_box(const Points& points);

}  // namespace corral
