// SPDX-License-Identifier: MIT
#include "kernel/surface/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace corral {
namespace {

constexpr std::int64_t kMargin = PointGrid::kLargestReach;  // empty cells around, so that no row runs into the next
constexpr int kSliceBits = 3, kMostSliceBits = 6;           // a cell has at least 8 slices along x
constexpr int kDigitBits = 11;                              // of the sort of the keys
constexpr std::ptrdiff_t kFew = 100;                        // points that insertion sorts
constexpr double kMostCells = 5e17;                         // keys with their slices are 63 bits

/// Places far from the corner are rounded to a share of the extent, others to less than this share of a radius.
constexpr double kRounding = 1e-9;
double rounding_of(const Points& points) {
  if (points.rows() == 0) return 0;
  return 4 * std::numeric_limits<double>::epsilon() *
         (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
}

/// The cell of every point as one number, ascending by z, then y, then x.
struct CellKeys {
  std::vector<std::int64_t> keys;
  std::int64_t row_step = 1, layer_step = 1;
};

/// Cells along one axis.
struct Axis {
  const double* values;
  double corner, side;
  std::int64_t cell(std::size_t i) const {
    const double place = (values[i] - corner) / side;
    return place < 4e18 ? static_cast<std::int64_t>(place) : 0;  // extents that are not finite have no cells
  }
};

/// Far outliers make more cells than keys can count: empty stretches are cut to the reach of a search, which no search can
/// tell.
std::vector<std::int64_t> cells_without_gaps(const Axis& axis, std::size_t count) {
  std::vector<std::int64_t> cells(count);
  for (std::size_t i = 0; i < count; ++i) cells[i] = axis.cell(i);
  std::vector<std::int64_t> taken = cells;
  std::sort(taken.begin(), taken.end());
  taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
  std::vector<std::int64_t> closed(taken.size(), 0);
  for (std::size_t i = 1; i < taken.size(); ++i)
    closed[i] = closed[i - 1] + std::min<std::int64_t>(taken[i] - taken[i - 1], PointGrid::kLargestReach + 1);
  for (std::int64_t& cell : cells)
    cell = closed[static_cast<std::size_t>(std::lower_bound(taken.begin(), taken.end(), cell) - taken.begin())];
  return cells;
}

/// Keys from cells along the axes, of which there are so many; nothing if that is too many.
template <class Cell>
std::optional<CellKeys> combine(const std::array<std::int64_t, 3>& largest, std::size_t count, const Cell& cell) {
  std::array<std::int64_t, 3> steps;
  double product = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    steps[axis] = largest[axis] + 1 + 2 * kMargin;
    product *= static_cast<double>(steps[axis]);
  }
  if (!(product <= kMostCells)) return std::nullopt;
  CellKeys result{std::vector<std::int64_t>(count), steps[0], steps[0] * steps[1]};
  for (std::size_t i = 0; i < count; ++i)
    result.keys[i] =
        (cell(2, i) + kMargin) * result.layer_step + (cell(1, i) + kMargin) * result.row_step + cell(0, i) + kMargin;
  return result;
}

/// Numbers the cells; `side` grows in the rare case that even without gaps there are too many.
CellKeys number_cells(const Points& points, const Eigen::RowVector3d& corner, double& side) {
  const auto count = static_cast<std::size_t>(points.rows());
  std::array<std::size_t, 3> last;  // the point with the largest coordinate
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Eigen::Index row = 0;
    points.col(static_cast<Eigen::Index>(axis)).maxCoeff(&row);
    last[axis] = static_cast<std::size_t>(row);
  }
  for (;; side *= 2) {
    std::array<Axis, 3> axes;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      axes[static_cast<std::size_t>(axis)] = {points.col(axis).data(), corner(axis), side};
    const auto direct = combine({axes[0].cell(last[0]), axes[1].cell(last[1]), axes[2].cell(last[2])}, count,
                                [&](std::size_t axis, std::size_t i) { return axes[axis].cell(i); });
    if (direct) return *direct;
    std::array<std::vector<std::int64_t>, 3> closed;
    for (std::size_t axis = 0; axis < 3; ++axis) closed[axis] = cells_without_gaps(axes[axis], count);
    const auto compact = combine({closed[0][last[0]], closed[1][last[1]], closed[2][last[2]]}, count,
                                 [&](std::size_t axis, std::size_t i) { return closed[axis][i]; });
    if (compact) return *compact;
  }
}

/// Sorts by key(item), least significant digits first; digits that all keys share cost a look.
template <class Item, class Key>
void radix_sort(std::vector<Item>& items, const Key& key) {
  constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
  std::vector<Item> other(items.size());
  std::int64_t all = 0;
  for (const Item& item : items) all |= key(item);
  for (int shift = 0; shift < 63 && (all >> shift) != 0; shift += kDigitBits) {
    const auto digit = [&](const Item& item) { return static_cast<std::size_t>(key(item) >> shift) & (kBuckets - 1); };
    std::array<std::size_t, kBuckets> places{};
    for (const Item& item : items) ++places[digit(item)];
    std::size_t next = 0;
    for (std::size_t& place : places) next += std::exchange(place, next);
    for (const Item& item : items) other[places[digit(item)]++] = item;
    items.swap(other);
  }
}

/// Slices leave little to the sort within a cell: as many as cost no further digit of the keys.
int slice_bits_for(const std::vector<std::int64_t>& keys) {
  std::int64_t all = 0;
  for (const std::int64_t key : keys) all |= key;
  int bits = kSliceBits;
  while (bits < 63 && all >> (bits - kSliceBits) != 0) ++bits;
  const int free = std::min(63, (bits + kDigitBits - 1) / kDigitBits * kDigitBits) - bits;
  return std::min(kSliceBits + free, kMostSliceBits);
}

/// By insertion: the fastest for a few that are nearly in order.
template <class Iterator, class Less>
void sort_few(Iterator first, Iterator last, const Less& is_less) {
  for (Iterator next = first; next != last; ++next)
    for (Iterator at = next; at != first && is_less(*at, *(at - 1)); --at) std::swap(*at, *(at - 1));
}

/// How many cells are taken: as bits, or sorted where these would be too many.
std::size_t count_cells(std::vector<std::int64_t> keys) {
  constexpr std::int64_t kBitsPerPoint = 256, kBits = 64;
  const auto [least, most] = std::minmax_element(keys.begin(), keys.end());
  const std::int64_t base = *least, extent = *most - base;
  if (extent / kBitsPerPoint > static_cast<std::int64_t>(keys.size())) {
    radix_sort(keys, [](std::int64_t key) { return key; });
    return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
  }
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(extent / kBits) + 1, 0);
  for (const std::int64_t key : keys)
    taken[static_cast<std::size_t>((key - base) / kBits)] |= std::uint64_t{1} << ((key - base) % kBits);
  std::size_t count = 0;
  for (const std::uint64_t bits : taken) count += static_cast<std::size_t>(__builtin_popcountll(bits));
  return count;
}

/// Coordinates far from the corner have no finer places than this.
double finest_side(const Points& points, const Eigen::RowVector3d& corner) {
  return std::max((points.colwise().maxCoeff() - corner).maxCoeff() * 1e-15, std::numeric_limits<double>::min());
}

}  // namespace

PointGrid PointGrid::for_radius(const Points& points, double radius, int reach) {
  return PointGrid(points, (radius * (1 + kRounding) + rounding_of(points)) / reach);
}

PointGrid::PointGrid(const Points& points, double cell_side) : side_(cell_side) {
  if (points.rows() == 0) {
    begins_ = {0};
    return;
  }
  corner_ = points.colwise().minCoeff();
  side_ = std::max(side_, finest_side(points, corner_));
  rounding_ = rounding_of(points);
  sort_into_cells(points);
}

void PointGrid::sort_into_cells(const Points& points) {
  struct Item {
    std::int64_t key;
    double x;
    int row;
  };
  std::vector<Item> items(static_cast<std::size_t>(points.rows()));
  int slice_bits = 0;
  {
    const CellKeys cells = number_cells(points, corner_, side_);
    row_step_ = cells.row_step;
    layer_step_ = cells.layer_step;
    slice_bits = slice_bits_for(cells.keys);
    const auto slices = static_cast<double>(std::int64_t{1} << slice_bits);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const double x = points(static_cast<Eigen::Index>(i), 0), place = (x - corner_.x()) / side_;
      const double slice = (place - std::floor(place)) * slices;
      items[i] = {(cells.keys[i] << slice_bits) + (slice < slices ? static_cast<std::int64_t>(slice) : 0), x,
                  static_cast<int>(i)};
    }
  }
  radix_sort(items, [](const Item& item) { return item.key; });
  const auto rest = [&](const Item& item) {
    return std::make_tuple(points(item.row, 1), points(item.row, 2), item.row);
  };
  for (auto first = items.begin(); first != items.end();) {
    auto last = first;
    const std::int64_t cell = first->key >> slice_bits;
    while (last != items.end() && last->key >> slice_bits == cell) ++last;
    const auto is_less = [&](const Item& a, const Item& b) { return a.x < b.x || (a.x == b.x && rest(a) < rest(b)); };
    if (last - first <= kFew)
      sort_few(first, last, is_less);
    else
      std::sort(first, last, is_less);
    keys_.push_back(cell);
    begins_.push_back(static_cast<int>(first - items.begin()));
    first = last;
  }
  begins_.push_back(static_cast<int>(items.size()));
  keys_.insert(keys_.end(), 2 * kLargestReach + 1, std::numeric_limits<std::int64_t>::max());  // where searches end
  rows_.resize(items.size());
  x_.resize(static_cast<std::size_t>(padded(size()) + kLanes), std::numeric_limits<double>::infinity());
  for (std::size_t slot = 0; slot < items.size(); ++slot) rows_[slot] = items[slot].row, x_[slot] = items[slot].x;
  y_ = by_slot(points.col(1));
  z_ = by_slot(points.col(2));
}

PointGrid PointGrid::with_occupancy(const Points& points, double occupancy) {
  if (points.rows() == 0) return PointGrid(points, 1);
  const auto count = static_cast<double>(points.rows());
  const Eigen::RowVector3d corner = points.colwise().minCoeff();
  double side = std::max(bounding_box_diagonal(points) / std::sqrt(count / occupancy), finest_side(points, corner));
  // On a surface the points in a cell grow as the square of its side.
  const double found = count / static_cast<double>(count_cells(number_cells(points, corner, side).keys));
  return PointGrid(points, side * std::sqrt(occupancy / found));
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

double PointGrid::sure_radius(int slot, int reach) const {
  const Eigen::Array3d inside = within_cell(slot);
  const double lowest = std::min({inside.x(), inside.y(), inside.z()}),
               highest = std::max({inside.x(), inside.y(), inside.z()});
  // A point on a face may be counted to either side.
  return std::max(0.0, (reach + std::min(lowest, 1 - highest)) * side_ * (1 - kRounding / 2) - rounding_);
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
  for (std::size_t i = cursors_.size(); i < offsets_.size(); ++i)  // the first call looks, the others step on
    cursors_.push_back(
        static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), here + offsets_[i]) - keys.begin()));
  const std::size_t before = ranges.size();
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const std::int64_t first = here + offsets_[i], last = first + 2 * reach_;
    const std::int64_t* at = &keys[cursors_[i]];
    while (*at < first) ++at;
    cursors_[i] = static_cast<std::size_t>(at - keys.data());
    std::size_t after = cursors_[i];
    for (int step = 0; step <= 2 * reach_; ++step) after += at[step] <= last ? 1 : 0;
    if (after == cursors_[i]) continue;
    const SlotRange range{grid_.begins_[cursors_[i]], grid_.begins_[after]};
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
