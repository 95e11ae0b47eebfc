// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernel/bounding_box.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/vectorized.h"

namespace corral {

/// Points sorted into cubic cells: the index for loops over the neighbourhood of every vertex, where a tree is several times
/// slower. A *slot* is a position in the sorted order: by cell, then by x, y, z, then by row. Sums over
/// neighbours run in this order, so that they do not depend on how the vertices are numbered.
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
  double rounding_ = 0;       // of the difference of two places among the cells, mesh units
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

/// Columns of the slots of some ranges, copied next to each other for loops that run over them often. The first column
/// is padded with infinity, at least sixteen numbers.
template <int kColumns>
class PackedSlots {
 public:
  int size() const { return size_; }
  const double* operator[](int column) const { return columns_[column].data(); }

  template <class Lanes>
  CORRAL_INLINE void collect(const AlignedColumn* const (&from)[kColumns], const SlotRange* first,
                             const SlotRange* last) {
    std::size_t count = 0;
    for (const SlotRange* range = first; range != last; ++range)
      count += static_cast<std::size_t>(range->end - range->begin);
    size_ = static_cast<int>(count);
    if (columns_[0].size() < count + kFloatLanes)
      for (AlignedColumn& column : columns_) column.resize(2 * count + kFloatLanes);
    const double* sources[kColumns];
    double* targets[kColumns];
    for (int i = 0; i < kColumns; ++i) sources[i] = from[i]->data(), targets[i] = columns_[i].data();
    for (const SlotRange* range = first; range != last; ++range) {
      const int length = range->end - range->begin;
      for (int at = 0; at < length; at += kLanes)  // the excess is overwritten
        for (int i = 0; i < kColumns; ++i) Lanes::load(sources[i] + range->begin + at).store(targets[i] + at);
      for (int i = 0; i < kColumns; ++i) targets[i] += length;
    }
    std::fill_n(targets[0], kFloatLanes, std::numeric_limits<double>::infinity());
  }

 private:
  AlignedColumn columns_[kColumns];
  int size_ = 0;
};

/// Calls visit(inside, dx, dy, dz, i) for eight places after the other, the first three columns of packed slots: `inside` is
/// true on the lanes that lie within a squared distance of (x, y, z), d their offsets from it, i the first of the eight. The
/// padding is infinitely far away, and so within no distance.
template <class Lanes, int kColumns, class Visit>
CORRAL_INLINE void visit_within(const PackedSlots<kColumns>& packed, double x, double y, double z, double squared,
                                const Visit& visit) {
  const Lanes cx = Lanes::fill(x), cy = Lanes::fill(y), cz = Lanes::fill(z),
              limit = Lanes::fill(std::min(squared, std::numeric_limits<double>::max()));
  const double *xs = packed[0], *ys = packed[1], *zs = packed[2];
  for (int i = 0; i < packed.size(); i += kLanes) {
    const Lanes dx = Lanes::load(xs + i) - cx, dy = Lanes::load(ys + i) - cy, dz = Lanes::load(zs + i) - cz;
    visit(dx * dx + dy * dy + dz * dz <= limit, dx, dy, dz, i);
  }
}

}  // namespace corral
