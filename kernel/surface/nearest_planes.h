// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/surface/search/point_grid.h"

namespace corral {

/// By slot of a grid: normals of the planes through the k nearest, and the squared distance of the nearest in another place.
struct NearestPlanes {
  AlignedColumn nx, ny, nz;  ///< the direction of least variance, to either side; zero where fewer than two have any
  AlignedColumn squares;     ///< infinite if the k nearest are in one place
};

/// Of every point of the grid. Floats list the candidates, doubles decide. Only sources include this.
/// Plain form  tests/support/reference/surface.h
NearestPlanes fit_nearest_planes(const Points& points, const PointGrid& grid, int k, const ParallelFor& parallel);

}  // namespace corral
