// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernel/bounding_box.h"
#include "kernel/columns.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// Points sorted into cubic cells: the index for loops over the neighbourhood of every vertex, where a tree is several times
/// slower. A *slot* is a position in the sorted order: by cell, then by x, y, z, then by row. Sums over
/// neighbours run in this order, so that they do not depend on how the vertices are numbered.
/// Plain form  tests/support/reference/surface.h
class PointGrid {
 public:
  /// Finite points; the side of a cell, positive, in their units. O(V) memory however far apart the points are.
  PointGrid(const Points& points, double cell_side);

  /// Cells such that everything within a radius of a point lies in the cells up to `reach` from its own.
  static PointGrid for_radius(const Points& points, double radius, int reach);

  /// Cells of about `occupancy` points each, where the points lie on a surface.
  static PointGrid with_occupancy(const Points& points, double occupancy);

  int size() const { return static_cast<int>(rows_.size()); }
  int row(int slot) const { return rows_[static_cast<std::size_t>(slot)]; }
  const AlignedColumn& x() const { return x_; }  ///< by slot, padded with infinity, which is within no distance
  const AlignedColumn& y() const { return y_; }
  const AlignedColumn& z() const { return z_; }

  double cell_side() const { return side_; }
  int cells() const { return static_cast<int>(begins_.size()) - 1; }  ///< occupied ones, in the order of the slots
  int begin(int cell) const { return begins_[static_cast<std::size_t>(cell)]; }
  int end(int cell) const { return begins_[static_cast<std::size_t>(cell) + 1]; }
  int cell_of(int slot) const;

  /// How far each slot's point is from the nearest face of its cell, in sides of a cell, 0 .. 0.5.
  AlignedColumn from_faces() const;

  /// The radius around a point at such a distance within which all points lie in the cells up to `reach` from its own.
  double sure_radius(double from_face, int reach) const;

  /// Squared distance of a slot's point to the middle of its cell.
  double from_middle(int slot) const;

  /// Values by row, in the order of the slots and padded.
  AlignedColumn by_slot(const Eigen::Ref<const Eigen::VectorXd>& values) const;

  static constexpr int kLargestReach = 9;

 private:
  friend class CellSweep;
  PointGrid(const Points& points, const BoundingBox& box, double cell_side);
  void sort_into_cells(const Points& points, const BoundingBox& box);
  Eigen::Array3d within_cell(int slot) const;  // 0 .. 1 along each axis

  double side_;
  double rounding_ = 0;  // of the difference of two places among the cells, mesh units
  Eigen::RowVector3d corner_;
  std::int64_t row_step_ = 1, layer_step_ = 1;  // difference of keys to the next y and the next z
  std::vector<int> rows_;
  AlignedColumn x_, y_, z_;
  std::vector<std::int64_t> keys_;  // of the occupied cells, ascending, and largest ones behind them
  std::vector<int> begins_;
};

/// Slots next to each other in the order of the grid.
struct SlotRange {
  int begin, end;
};

/// Walks over cells in ascending order and gives the slots around each.
class CellSweep {
 public:
  /// `reach`: cells up to this many away along each axis, at most kLargestReach.
  CellSweep(const PointGrid& grid, int reach);

  /// Appends the slots around a cell, ascending. `cell` must not be smaller than at the call before.
  void around(int cell, std::vector<SlotRange>& ranges);

 private:
  const PointGrid& grid_;
  int reach_;
  std::vector<std::int64_t> offsets_;  // of keys, to the first cell of each row of cells
  std::vector<std::size_t> cursors_;   // first cell that is not before it
};

/// What CellSweep gives for every cell, stored for loops that need it more than once.
class CellNeighborhoods {
 public:
  CellNeighborhoods(const PointGrid& grid, int reach);
  const SlotRange* begin(int cell) const { return &ranges_[begins_[static_cast<std::size_t>(cell)]]; }
  const SlotRange* end(int cell) const { return &ranges_[begins_[static_cast<std::size_t>(cell) + 1]]; }

 private:
  std::vector<SlotRange> ranges_;
  std::vector<std::size_t> begins_;
};

}  // namespace corral
