// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/search/point_grid.h"

namespace corral {

/// point_resolution() of points whose neighbours were looked at. `squares`: by slot, the squared distance to the nearest point
/// in another place; infinite where it is not known. Only sources include this.
double mean_nearest(const PointGrid& grid, const Points& points, AlignedColumn squares);

}  // namespace corral
