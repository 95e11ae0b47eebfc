// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/search/point_grid.h"
#include "kernel/surface/search/resolution.h"

namespace corral {

/// point_spacing() of points whose neighbours were looked at. `squares`: by slot, the squared distance to the nearest point
/// in another place; infinite where it is not known. Only sources include this.
PointSpacing mean_nearest(const PointGrid& grid, const Points& points, AlignedColumn squares);

}  // namespace corral
