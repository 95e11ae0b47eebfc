// SPDX-License-Identifier: MIT
#include "kernel/surface/search/cell_keys.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "kernel/surface/search/cell_numbers.h"

namespace corral {
namespace {

constexpr int kSliceBits = 5, kMostSliceBits = 6;  // a cell has at least 32 slices along x
constexpr int kDigitBits = 11;                     // of the sort of the keys
constexpr double kMostCells = 5e17;                // keys with their slices are 63 bits

/// The cell of every point as one number, ascending by z, then y, then x.
struct CellKeys {
  std::vector<std::int64_t> keys;
  std::int64_t row_step = 1, layer_step = 1;
};

CellAxis axis_of(const Points& points, const BoundingBox& box, int axis, double side) {
  return {points.col(axis).data(), box.low(axis), side, box.high(axis)};
}

/// Far outliers make more cells than keys can count: empty stretches are shortened to the reach of a search, which changes no
/// result.
std::vector<std::int64_t> cells_without_gaps(const CellAxis& axis, std::size_t count) {
  std::vector<std::int64_t> cells(count);
  for (std::size_t i = 0; i < count; ++i) cells[i] = axis.cell(axis.values[i]);
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
    steps[axis] = largest[axis] + 1 + 2 * kCellMargin;
    product *= static_cast<double>(steps[axis]);
  }
  if (!(product <= kMostCells)) return std::nullopt;
  CellKeys result{std::vector<std::int64_t>(count), steps[0], steps[0] * steps[1]};
  for (std::size_t i = 0; i < count; ++i)
    result.keys[i] = (cell(2, i) + kCellMargin) * result.layer_step + (cell(1, i) + kCellMargin) * result.row_step +
                     cell(0, i) + kCellMargin;
  return result;
}

/// combine() of the cells along the axes as they are, where all keys are whole numbers that doubles can hold.
std::optional<CellKeys> combine_on_lanes(const std::array<CellAxis, 3>& axes, std::size_t count) {
  const auto cells = [&](std::size_t axis) {
    return std::floor(axes[axis].place(axes[axis].last)) + 1 + 2 * kCellMargin;
  };
  const double row_step = cells(0), layer_step = row_step * cells(1);
  if (!(layer_step * cells(2) <= kMostWhole)) return std::nullopt;
  CellKeys result{std::vector<std::int64_t>(count), static_cast<std::int64_t>(row_step),
                  static_cast<std::int64_t>(layer_step)};
  combine_cells(axes, row_step, layer_step, result.keys);
  return result;
}

/// In which of so many slices of its cell along an axis each point lies; all in the first if the extent is infinite.
std::vector<std::int64_t> slices_of(const CellAxis& axis, double slices, std::size_t count) {
  std::vector<std::int64_t> numbers(count, 0);
  if (!(axis.place(axis.last) <= kMostWhole)) return numbers;
  number_slices(axis, slices, numbers);
  return numbers;
}

/// Numbers the cells; `side` grows in the rare case that even without gaps there are too many.
CellKeys number_cells(const Points& points, const BoundingBox& box, double& side) {
  const auto count = static_cast<std::size_t>(points.rows());
  for (;; side *= 2) {
    const std::array<CellAxis, 3> axes{axis_of(points, box, 0, side), axis_of(points, box, 1, side),
                                       axis_of(points, box, 2, side)};
    if (auto fast = combine_on_lanes(axes, count)) return *std::move(fast);
    const auto direct =
        combine({axes[0].cell(box.high(0)), axes[1].cell(box.high(1)), axes[2].cell(box.high(2))}, count,
                [&](std::size_t axis, std::size_t i) { return axes[axis].cell(axes[axis].values[i]); });
    if (direct) return *direct;
    std::array<std::vector<std::int64_t>, 3> closed;
    std::array<std::int64_t, 3> largest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      closed[axis] = cells_without_gaps(axes[axis], count);
      largest[axis] = *std::max_element(closed[axis].begin(), closed[axis].end());
    }
    const auto compact = combine(largest, count, [&](std::size_t axis, std::size_t i) { return closed[axis][i]; });
    if (compact) return *compact;
  }
}

/// Sorts by all but the last `bits` bits, which keep their order; digits that all numbers share are skipped.
void radix_sort(std::vector<std::uint64_t>& numbers, int left_out = 0) {
  constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
  std::vector<std::uint64_t> other(numbers.size());
  std::uint64_t all = 0;
  for (const std::uint64_t number : numbers) all |= number;
  for (int shift = left_out; shift < 64 && (all >> shift) != 0; shift += kDigitBits) {
    const auto digit = [shift](std::uint64_t number) {
      return static_cast<std::size_t>(number >> shift) & (kBuckets - 1);
    };
    std::array<std::size_t, kBuckets> places{};
    for (const std::uint64_t number : numbers) ++places[digit(number)];
    std::size_t next = 0;
    for (std::size_t& place : places) next += std::exchange(place, next);
    for (const std::uint64_t number : numbers) other[places[digit(number)]++] = number;
    numbers.swap(other);
  }
}

int bits_of(std::uint64_t number) {
  int bits = 0;
  for (; number != 0; number >>= 1) ++bits;
  return bits;
}

/// Sorts keys, and tells the rows that they were in; equal ones stay in order.
Indices sort_keys(std::vector<std::int64_t>& keys) {
  Indices rows(keys.size());
  std::uint64_t all = 0;
  for (const std::int64_t key : keys) all |= static_cast<std::uint64_t>(key);
  const int row_bits = bits_of(keys.size());
  if (bits_of(all) + row_bits > 64) {
    std::iota(rows.begin(), rows.end(), 0);
    const auto key_of = [&](int row) { return keys[static_cast<std::size_t>(row)]; };
    std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return key_of(a) < key_of(b); });
    std::vector<std::int64_t> sorted;
    std::transform(rows.begin(), rows.end(), std::back_inserter(sorted), key_of);
    keys.swap(sorted);
    return rows;
  }
  std::vector<std::uint64_t> packed(keys.size());
  for (std::size_t row = 0; row < keys.size(); ++row)
    packed[row] = static_cast<std::uint64_t>(keys[row]) << row_bits | row;
  radix_sort(packed, row_bits);
  const std::uint64_t row_mask = (std::uint64_t{1} << row_bits) - 1;
  for (std::size_t i = 0; i < packed.size(); ++i) {
    keys[i] = static_cast<std::int64_t>(packed[i] >> row_bits);
    rows[i] = static_cast<int>(packed[i] & row_mask);
  }
  return rows;
}

/// Slices leave little to the sort within a cell: as many as cost no further digit of the keys.
int slice_bits_for(const std::vector<std::int64_t>& keys) {
  std::uint64_t all = 0;
  for (const std::int64_t key : keys) all |= static_cast<std::uint64_t>(key);
  const int bits = std::min(63, bits_of(all) + kSliceBits);
  const int free = std::min(63, (bits + kDigitBits - 1) / kDigitBits * kDigitBits) - bits;
  return std::min(kSliceBits + free, kMostSliceBits);
}

}  // namespace

std::size_t count_cells(const Points& points, const BoundingBox& box, double& side) {
  const std::vector<std::int64_t> keys = number_cells(points, box, side).keys;
  constexpr std::int64_t kBitsPerPoint = 256, kBits = 64;
  const auto [least, most] = std::minmax_element(keys.begin(), keys.end());
  const std::int64_t base = *least, extent = *most - base;
  if (extent / kBitsPerPoint > static_cast<std::int64_t>(keys.size())) {
    std::vector<std::uint64_t> sorted(keys.begin(), keys.end());
    radix_sort(sorted);
    return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
  }
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(extent / kBits) + 1, 0);
  for (const std::int64_t key : keys)
    taken[static_cast<std::size_t>((key - base) / kBits)] |= std::uint64_t{1} << ((key - base) % kBits);
  std::size_t count = 0;
  for (const std::uint64_t bits : taken) count += std::bitset<64>(bits).count();
  return count;
}

SortedCells sort_by_cell(const Points& points, const BoundingBox& box, double& side) {
  CellKeys numbered = number_cells(points, box, side);
  std::vector<std::int64_t>& keys = numbered.keys;
  const int slice_bits = slice_bits_for(keys);
  const auto slices = static_cast<double>(std::int64_t{1} << slice_bits);
  const std::vector<std::int64_t> slice = slices_of(axis_of(points, box, 0, side), slices, keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = (keys[i] << slice_bits) + slice[i];
  Indices rows = sort_keys(keys);
  for (std::int64_t& key : keys) key >>= slice_bits;
  return {std::move(rows), std::move(keys), numbered.row_step, numbered.layer_step};
}

}  // namespace corral
