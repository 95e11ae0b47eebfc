// SPDX-License-Identifier: MIT
#include "kernel/surface/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

namespace corral {
namespace {

constexpr std::int64_t kMargin = PointGrid::kLargestReach;  // empty cells around, so that no row runs into the next
constexpr double kMostCells = 4e18;                         // keys are 63 bits

/// A point on its way to its place.
struct Keyed {
  std::int64_t key;
  int row;
};

/// Cell coordinates along one axis.
std::vector<std::int64_t> cell_coordinates(const Eigen::Ref<const Eigen::VectorXd>& values, double corner, double side) {
  std::vector<std::int64_t> cells(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double cell = (values(static_cast<Eigen::Index>(i)) - corner) / side;
    cells[i] = cell < 4e18 ? static_cast<std::int64_t>(cell) : 0;  // extents that are not finite have no cells
  }
  return cells;
}

/// Far outliers make more cells than keys can count: empty stretches are cut to the reach of a search, which no search can
/// tell.
void close_gaps(std::vector<std::int64_t>& cells) {
  std::vector<std::int64_t> taken = cells;
  std::sort(taken.begin(), taken.end());
  taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
  std::vector<std::int64_t> closed(taken.size(), 0);
  for (std::size_t i = 1; i < taken.size(); ++i)
    closed[i] = closed[i - 1] + std::min<std::int64_t>(taken[i] - taken[i - 1], PointGrid::kLargestReach + 1);
  for (std::int64_t& cell : cells)
    cell = closed[static_cast<std::size_t>(std::lower_bound(taken.begin(), taken.end(), cell) - taken.begin())];
}

/// Least significant digits first; digits that all keys share cost a look.
void radix_sort(std::vector<Keyed>& items) {
  constexpr int kBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kBits;
  std::vector<Keyed> other(items.size());
  std::int64_t all = 0;
  for (const Keyed& item : items) all |= item.key;
  for (int shift = 0; shift < 63 && (all >> shift) != 0; shift += kBits) {
    const auto digit = [shift](const Keyed& item) {
      return static_cast<std::size_t>(item.key >> shift) & (kBuckets - 1);
    };
    std::array<std::size_t, kBuckets> places{};
    for (const Keyed& item : items) ++places[digit(item)];
    std::size_t next = 0;
    for (std::size_t& place : places) next += std::exchange(place, next);
    for (const Keyed& item : items) other[places[digit(item)]++] = item;
    items.swap(other);
  }
}

}  // namespace

PointGrid::PointGrid(const Points& points, double cell_side) : side_(cell_side) {
  if (points.rows() == 0) {
    begins_ = {0};
    return;
  }
  corner_ = points.colwise().minCoeff();
  // Cell coordinates must fit into 62 bits each, and doubles far from the corner have no finer places anyway.
  side_ = std::max(side_, (points.colwise().maxCoeff() - corner_).maxCoeff() * 1e-15);
  side_ = std::max(side_, std::numeric_limits<double>::min());
  sort_into_cells(points);
}

void PointGrid::sort_into_cells(const Points& points) {
  std::array<std::vector<std::int64_t>, 3> cells;
  std::array<std::int64_t, 3> counts;
  const auto measure = [&] {
    double product = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      counts[axis] = *std::max_element(cells[axis].begin(), cells[axis].end()) + 1 + 2 * kMargin;
      product *= static_cast<double>(counts[axis]);
    }
    return product;
  };
  for (;; side_ *= 2) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto column = static_cast<Eigen::Index>(axis);
      cells[axis] = cell_coordinates(points.col(column), corner_(column), side_);
    }
    if (measure() <= kMostCells) break;
    for (auto& coordinates : cells) close_gaps(coordinates);
    if (measure() <= kMostCells) break;
  }
  row_step_ = counts[0];
  layer_step_ = counts[0] * counts[1];

  std::vector<Keyed> items(static_cast<std::size_t>(points.rows()));
  for (std::size_t i = 0; i < items.size(); ++i)
    items[i] = {(cells[2][i] + kMargin) * layer_step_ + (cells[1][i] + kMargin) * row_step_ + cells[0][i] + kMargin,
                static_cast<int>(i)};
  radix_sort(items);
  const auto key = [&](const Keyed& item) {
    return std::make_tuple(points(item.row, 0), points(item.row, 1), points(item.row, 2), item.row);
  };
  for (auto first = items.begin(); first != items.end();) {
    auto last = first;
    while (last != items.end() && last->key == first->key) ++last;
    std::sort(first, last, [&](const Keyed& a, const Keyed& b) { return key(a) < key(b); });
    keys_.push_back(first->key);
    begins_.push_back(static_cast<int>(first - items.begin()));
    first = last;
  }
  begins_.push_back(static_cast<int>(items.size()));
  rows_.resize(items.size());
  for (std::size_t slot = 0; slot < items.size(); ++slot) rows_[slot] = items[slot].row;
  x_ = by_slot(points.col(0));
  y_ = by_slot(points.col(1));
  z_ = by_slot(points.col(2));
}

PointGrid PointGrid::with_occupancy(const Points& points, double occupancy) {
  const double count = static_cast<double>(std::max<Eigen::Index>(points.rows(), 1));
  const double extent = bounding_box_diagonal(points);
  PointGrid grid(points, extent > 0 ? extent / std::sqrt(count / occupancy) : 1);
  // On a surface the points in a cell grow as the square of its side.
  const double found = count / std::max(grid.cells(), 1);
  if (found > 0.7 * occupancy && found < 1.5 * occupancy) return grid;
  return PointGrid(points, grid.cell_side() * std::sqrt(occupancy / found));
}

int PointGrid::cell_of(int slot) const {
  return static_cast<int>(std::upper_bound(begins_.begin(), begins_.end(), slot) - begins_.begin()) - 1;
}

Eigen::Array3d PointGrid::within_cell(int slot) const {
  const auto i = static_cast<std::size_t>(slot);
  const Eigen::Array3d place = (Eigen::Array3d(x_[i], y_[i], z_[i]) - corner_.transpose().array()) / side_;
  return place - place.floor();
}

double PointGrid::sure_radius(int slot, int reach) const {
  const Eigen::Array3d inside = within_cell(slot);
  const double nearest_face = std::min(inside.minCoeff(), 1 - inside.maxCoeff());
  return (reach + nearest_face) * side_ * (1 - 1e-9);  // a point on a face may be counted to either side
}

double PointGrid::from_middle(int slot) const { return (within_cell(slot) - 0.5).square().sum() * side_ * side_; }

Column PointGrid::by_slot(const Eigen::Ref<const Eigen::VectorXd>& values) const {
  Column column(static_cast<std::size_t>(padded(size()) + kLanes), 0.0);
  for (std::size_t slot = 0; slot < rows_.size(); ++slot) column[slot] = values(rows_[slot]);
  return column;
}

CellSweep::CellSweep(const PointGrid& grid, int reach) : grid_(grid), reach_(reach) {
  for (int layer = -reach; layer <= reach; ++layer)
    for (int row = -reach; row <= reach; ++row)
      offsets_.push_back(layer * grid.layer_step_ + row * grid.row_step_ - reach);
  cursors_.reserve(offsets_.size());
}

void CellSweep::around(int cell, std::vector<SlotRange>& ranges) {
  const auto& keys = grid_.keys_;
  const std::int64_t here = keys[static_cast<std::size_t>(cell)];
  for (std::size_t i = cursors_.size(); i < offsets_.size(); ++i)  // the first call looks, the others step on
    cursors_.push_back(
        static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), here + offsets_[i]) - keys.begin()));
  const std::size_t before = ranges.size();
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const std::int64_t first = here + offsets_[i], last = first + 2 * reach_;
    std::size_t& cursor = cursors_[i];
    while (cursor < keys.size() && keys[cursor] < first) ++cursor;
    std::size_t after = cursor;
    while (after < keys.size() && keys[after] <= last) ++after;
    if (after == cursor) continue;
    const SlotRange range{grid_.begins_[cursor], grid_.begins_[after]};
    if (ranges.size() > before && ranges.back().end == range.begin)
      ranges.back().end = range.end;
    else
      ranges.push_back(range);
  }
}

CellNeighborhoods::CellNeighborhoods(const PointGrid& grid, int reach) {
  CellSweep sweep(grid, reach);
  begins_.reserve(static_cast<std::size_t>(grid.cells()) + 1);
  for (int cell = 0; cell < grid.cells(); ++cell) {
    begins_.push_back(ranges_.size());
    sweep.around(cell, ranges_);
  }
  begins_.push_back(ranges_.size());
  ranges_.push_back({0, 0});  // so that end() of the last cell has an address
}

}  // namespace corral
