// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/search/point_grid.h"

namespace corral {

/// What a local maximum must satisfy.
struct MaximumRule {
  double squared_radius;  ///< no other point up to this squared distance, included, may have a larger value
  double smallest;        ///< accepted value, positive
};

/// The slots of the points that have the largest value around them, ascending; ties go to the lower row. `values` by slot,
/// none NaN; `around` with a reach that covers the radius.
Indices local_maxima(const PointGrid& grid, const CellNeighborhoods& around, const AlignedColumn& values,
                     const MaximumRule& rule);

/// The rows of some slots, ascending.
Indices sorted_rows(const PointGrid& grid, const Indices& slots);

}  // namespace corral
