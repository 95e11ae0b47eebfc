// SPDX-License-Identifier: MIT
#include "kernel/surface/search/point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "kernel/surface/search/cell_keys.h"
#include "kernel/surface/search/cell_numbers.h"

namespace corral {
namespace {

constexpr std::size_t kFew = 100;  // points that insertion sorts

constexpr double kRounding = 1e-9;

/// Places far from the corner are rounded to this, others to less than kRounding of a radius.
double rounding_in(const BoundingBox& box) { return 4 * std::numeric_limits<double>::epsilon() * box.longest_side(); }

/// Coordinates far from the corner have no finer places than this: a cell's number is far below kMostWhole.
double finest_side(const BoundingBox& box) {
  return std::max(box.longest_side() * 1e-15, std::numeric_limits<double>::min());
}

}  // namespace

PointGrid PointGrid::for_radius(const Points& points, double radius, int reach) {
  const BoundingBox box = bounding_box(points);
  return PointGrid(points, box, (radius * (1 + kRounding) + rounding_in(box)) / reach);
}

PointGrid::PointGrid(const Points& points, double cell_side) : PointGrid(points, bounding_box(points), cell_side) {}

PointGrid::PointGrid(const Points& points, const BoundingBox& box, double cell_side)
    : side_(std::max(cell_side, finest_side(box))), rounding_(rounding_in(box)), corner_(box.low) {
  if (points.rows() == 0)
    begins_ = {0};
  else
    sort_into_cells(points, box);
}

void PointGrid::sort_into_cells(const Points& points, const BoundingBox& box) {
  SortedCells sorted = sort_by_cell(points, box, side_);
  row_step_ = sorted.row_step;
  layer_step_ = sorted.layer_step;
  rows_ = std::move(sorted.rows);
  x_ = by_slot(points.col(0));
  std::fill(x_.begin() + size(), x_.end(), std::numeric_limits<double>::infinity());
  struct Item {
    double x;
    int row;
  };
  const auto is_less = [&](const Item& a, const Item& b) {
    if (a.x != b.x) return a.x < b.x;
    const auto rest = [&](int row) { return std::make_tuple(points(row, 1), points(row, 2), row); };
    return rest(a.row) < rest(b.row);
  };
  const auto put = [&](std::size_t slot, const Item& item) { x_[slot] = item.x, rows_[slot] = item.row; };
  std::vector<Item> items;  // of a cell with many
  for (std::size_t first = 0, last = 0; first < rows_.size(); first = last) {
    const std::int64_t cell = sorted.cells[first];
    while (last < rows_.size() && sorted.cells[last] == cell) ++last;
    if (last - first <= kFew) {  // by insertion: they are nearly in order
      for (std::size_t next = first + 1; next < last; ++next) {
        const Item item{x_[next], rows_[next]};
        std::size_t at = next;
        for (; at != first && is_less(item, {x_[at - 1], rows_[at - 1]}); --at) put(at, {x_[at - 1], rows_[at - 1]});
        put(at, item);
      }
    } else {
      items.clear();
      for (std::size_t slot = first; slot < last; ++slot) items.push_back({x_[slot], rows_[slot]});
      std::sort(items.begin(), items.end(), is_less);
      for (std::size_t i = 0; i < items.size(); ++i) put(first + i, items[i]);
    }
    keys_.push_back(cell);
    begins_.push_back(static_cast<int>(first));
  }
  begins_.push_back(size());
  keys_.insert(keys_.end(), 2 * kLargestReach + 1, std::numeric_limits<std::int64_t>::max());  // where searches end
  y_ = by_slot(points.col(1));
  z_ = by_slot(points.col(2));
}

PointGrid PointGrid::with_occupancy(const Points& points, double occupancy) {
  if (points.rows() == 0) return PointGrid(points, 1);
  const auto count = static_cast<double>(points.rows());
  const BoundingBox box = bounding_box(points);
  double side = std::max(box.diagonal() / std::sqrt(count / occupancy), finest_side(box));
  // On a surface the points in a cell grow as the square of its side.
  const double found = count / static_cast<double>(count_cells(points, box, side));
  return PointGrid(points, box, side * std::sqrt(occupancy / found));
}

int PointGrid::cell_of(int slot) const {
  return static_cast<int>(std::upper_bound(begins_.begin(), begins_.end(), slot) - begins_.begin()) - 1;
}

Eigen::Array3d PointGrid::within_cell(int slot) const {
  const auto i = static_cast<std::size_t>(slot);
  const auto share = [&](double value, double corner) {
    const double place = (value - corner) / side_;
    return place < 4e18 ? place - static_cast<double>(static_cast<std::int64_t>(place)) : 0;
  };
  return {share(x_[i], corner_.x()), share(y_[i], corner_.y()), share(z_[i], corner_.z())};
}

AlignedColumn PointGrid::from_faces() const {
  AlignedColumn shares(x_.size(), 0.0);
  const CellAxis axes[] = {
      {x_.data(), corner_.x(), side_}, {y_.data(), corner_.y(), side_}, {z_.data(), corner_.z(), side_}};
  measure_from_faces(axes, size(), shares.data());
  return shares;
}

double PointGrid::sure_radius(double from_face, int reach) const {
  // A point on a face may be counted to either side.
  return std::max(0.0, (reach + from_face) * side_ * (1 - kRounding / 2) - rounding_);
}

double PointGrid::from_middle(int slot) const { return (within_cell(slot) - 0.5).square().sum() * side_ * side_; }

AlignedColumn PointGrid::by_slot(const Eigen::Ref<const Eigen::VectorXd>& values) const {
  AlignedColumn column(static_cast<std::size_t>(padded(size()) + kLanes), 0.0);
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
  for (std::size_t i = cursors_.size(); i < offsets_.size(); ++i)  // the first call searches, the others advance
    cursors_.push_back(
        static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), here + offsets_[i]) - keys.begin()));
  std::size_t count = ranges.size();
  ranges.resize(count + offsets_.size());
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const std::int64_t first = here + offsets_[i], last = first + 2 * reach_;
    const std::int64_t* at = &keys[cursors_[i]];
    at += *at < first;  // the usual case of a step along x, without a branch
    while (*at < first) ++at;
    cursors_[i] = static_cast<std::size_t>(at - keys.data());
    std::size_t after = cursors_[i];
    for (int step = 0; step <= 2 * reach_; ++step) after += at[step] <= last ? 1 : 0;
    ranges[count] = {grid_.begins_[cursors_[i]], grid_.begins_[after]};
    count += after != cursors_[i];
  }
  ranges.resize(count);
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
