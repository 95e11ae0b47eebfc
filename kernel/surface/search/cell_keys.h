// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/bounding_box.h"
#include "kernel/types.h"
#include "kernel/vectorized.h"

namespace corral {

// The cells of a PointGrid as numbers. Only sources include this.

constexpr double kMostWhole = 0x1p51;  ///< whole numbers up to here are exact in double, with a margin

/// Rounded down; for numbers from 0 to kMostWhole.
template <class Lanes>
CORRAL_INLINE Lanes floor_of(const Lanes& number) {
  const Lanes shift = Lanes::fill(0x1p52), nearest = (number + shift) - shift;
  return select(number < nearest, nearest - Lanes::fill(1), nearest);
}

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
