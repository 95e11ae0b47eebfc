// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/bounding_box.h"
#include "kernel/types.h"

namespace corral {

// The cells of a PointGrid as numbers. Only sources include this.

/// How many cells of a side hold some of the points; the side grows where there are more cells than numbers.
std::size_t count_cells(const Points& points, const BoundingBox& box, double& side);

/// The points in the order of their cells: by z, then y, then x.
struct SortedCells {
  Indices rows;                       ///< within a cell nearly by x
  std::vector<std::int64_t> cells;    ///< of those rows
  std::int64_t row_step, layer_step;  ///< difference of cells to the next y and the next z
};

/// The side grows in the same rare case.
SortedCells sort_by_cell(const Points& points, const BoundingBox& box, double& side);

}  // namespace corral
