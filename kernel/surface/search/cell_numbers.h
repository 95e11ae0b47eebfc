// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/surface/search/point_grid.h"

namespace corral {

// The numbers of cells, eight points at a time. Only sources include this.

constexpr double kMostWhole = 0x1p51;  ///< whole numbers that doubles hold, and some to spare
constexpr std::int64_t kCellMargin =
    PointGrid::kLargestReach;  ///< empty cells around, so that no row runs into the next

/// The points and cells along one axis.
struct CellAxis {
  const double* values;
  double corner, side;
  double last = 0;  // the largest value
  double place(double value) const { return (value - corner) / side; }
  std::int64_t cell(double value) const {
    return place(value) < 4e18 ? static_cast<std::int64_t>(place(value)) : 0;  // infinite extents have no cells
  }
};

/// keys[i] = cell of z * layer_step + cell of y * row_step + cell of x, each of them with the margin; at most kMostWhole.
void combine_cells(const std::array<CellAxis, 3>& axes, double row_step, double layer_step,
                   std::vector<std::int64_t>& keys);

/// In which of so many slices of its cell along an axis each point lies.
void number_slices(const CellAxis& axis, double slices, std::vector<std::int64_t>& numbers);

/// How far so many points (padded) are from the nearest face of their cells, in sides of a cell.
void measure_from_faces(const CellAxis (&axes)[3], int count, double* shares);

}  // namespace corral
