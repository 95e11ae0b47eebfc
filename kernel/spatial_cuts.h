// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>

#include "kernel/columns.h"

namespace corral {

// What spatial_order() cuts, part by part. Only sources include this.

constexpr int kSpatialBranches = 8;  ///< of a node, and points of a full leaf

/// Places as floats that are 1 at most, which is enough for an order, and the bits of their rows.
struct SpatialItems {
  static constexpr int kColumns = 4;
  FloatColumn columns[kColumns];

  explicit SpatialItems(int count) {
    for (FloatColumn& column : columns) column.resize(static_cast<std::size_t>(padded(count, kFloatLanes)));
  }
  float* column(int i) { return columns[i].data(); }

  void set(int at, const Eigen::RowVector3d& place, std::int32_t row) {
    for (int axis = 0; axis < 3; ++axis) column(axis)[at] = static_cast<float>(place(axis));
    std::memcpy(column(3) + at, &row, sizeof(row));
  }
  int row(int at) {
    std::int32_t row;
    std::memcpy(&row, column(3) + at, sizeof(row));
    return row;
  }
};

/// Items first .. last - 1, which are to become shares of so many.
struct SpatialPart {
  int first, last, share;
  int size() const { return last - first; }
};

/// Cuts a part along the longest side of its box, and so on, until no part is larger than the least share. Touches nothing
/// but items of the part.
void divide(SpatialItems& items, const SpatialPart& part, int least_share);

}  // namespace corral
