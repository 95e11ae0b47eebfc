// SPDX-License-Identifier: MIT
#include "kernel/surface/search/cell_numbers.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/search/cell_numbers.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// Rounded down; for numbers from 0 to kMostWhole.
HWY_INLINE Lanes floor_of(const Lanes& number) {
  const Lanes shift = Lanes::fill(0x1p52), nearest = (number + shift) - shift;
  return select(number < nearest, nearest - Lanes::fill(1), nearest);
}

/// results[i] = number(load) for every i, eight at a time, where load(column) is of lanes from i on; whole numbers.
template <class Number>
HWY_INLINE void compute_all(std::vector<std::int64_t>& results, const Number& number) {
  for (std::size_t first = 0; first < results.size(); first += kLanes) {
    const std::size_t count = std::min(results.size() - first, std::size_t{kLanes});
    const auto load = [&](const double* column) HWY_ATTR {
      if (count == kLanes) return Lanes::load(column + first);
      double some[kLanes];
      std::fill_n(std::copy_n(column + first, count, some), kLanes - count, column[first]);
      return Lanes::load(some);
    };
    double numbers[kLanes];
    number(load).store(numbers);
    std::transform(numbers, numbers + count, &results[first],
                   [](double each) { return static_cast<std::int64_t>(each); });
  }
}

HWY_FLATTEN void combine_cells(const std::array<CellAxis, 3>& axes, double row_step, double layer_step,
                               std::vector<std::int64_t>& keys) {
  compute_all(keys, [&](const auto& load) HWY_ATTR {
    const auto cell = [&](std::size_t axis) HWY_ATTR {
      const Lanes offset = load(axes[axis].values) - Lanes::fill(axes[axis].corner);
      return floor_of(offset / Lanes::fill(axes[axis].side)) + Lanes::fill(kCellMargin);
    };
    return cell(2) * Lanes::fill(layer_step) + cell(1) * Lanes::fill(row_step) + cell(0);
  });
}

HWY_FLATTEN void number_slices(const CellAxis& axis, double slices, std::vector<std::int64_t>& numbers) {
  compute_all(numbers, [&](const auto& load) HWY_ATTR {
    const Lanes place = (load(axis.values) - Lanes::fill(axis.corner)) / Lanes::fill(axis.side);
    return floor_of((place - floor_of(place)) * Lanes::fill(slices));
  });
}

HWY_FLATTEN void measure_from_faces(const CellAxis (&axes)[3], int count, double* shares) {
  const auto inside = [&](const CellAxis& axis, int first) HWY_ATTR {
    const Lanes place = (Lanes::load(axis.values + first) - Lanes::fill(axis.corner)) / Lanes::fill(axis.side);
    return place - floor_of(place);
  };
  for (int first = 0; first < count; first += kLanes) {
    const Lanes x = inside(axes[0], first), y = inside(axes[1], first), z = inside(axes[2], first);
    const Lanes lowest = smaller(smaller(x, y), z), highest = larger(larger(x, y), z);
    smaller(lowest, Lanes::fill(1) - highest).store(shares + first);
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(combine_cells);
HWY_EXPORT(number_slices);
HWY_EXPORT(measure_from_faces);

void combine_cells(const std::array<CellAxis, 3>& axes, double row_step, double layer_step,
                   std::vector<std::int64_t>& keys) {
  HWY_DYNAMIC_DISPATCH(combine_cells)(axes, row_step, layer_step, keys);
}

void number_slices(const CellAxis& axis, double slices, std::vector<std::int64_t>& numbers) {
  HWY_DYNAMIC_DISPATCH(number_slices)(axis, slices, numbers);
}

void measure_from_faces(const CellAxis (&axes)[3], int count, double* shares) {
  HWY_DYNAMIC_DISPATCH(measure_from_faces)(axes, count, shares);
}

}  // namespace corral
#endif
