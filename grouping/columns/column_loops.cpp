// SPDX-License-Identifier: MIT
#include "grouping/columns/column_loops.h"

#include <cmath>
#include <limits>

#include "grouping/columns/compatibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/columns/column_loops.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_FLATTEN void divide_columns(const double* first, const double* second, std::size_t count, double* ratios) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  const std::size_t whole = count - count % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    const Lanes divisor = Lanes::load(second + i);
    select(Lanes::fill(0) < divisor, Lanes::load(first + i) / divisor, Lanes::fill(kAbsent)).store(ratios + i);
  }
  for (std::size_t i = whole; i < count; ++i) ratios[i] = second[i] > 0 ? first[i] / second[i] : kAbsent;
}

template <class Number>
HWY_INLINE Number variance(Number lower_weight, Number lower, Number all_weight, Number all) {
  const Number upper_weight = all_weight - lower_weight;
  const Number gap = lower / lower_weight - (all - lower) / upper_weight;
  return lower_weight * upper_weight * gap * gap;
}

HWY_FLATTEN void between_class_variances(const double* lower_weights, const double* lower_sums, const ClassSums& all,
                                         std::size_t count, double* variances) {
  const std::size_t whole = count - count % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes)
    variance(Lanes::load(lower_weights + i), Lanes::load(lower_sums + i), Lanes::fill(all.weight), Lanes::fill(all.sum))
        .store(variances + i);
  for (std::size_t i = whole; i < count; ++i)
    variances[i] = variance(lower_weights[i], lower_sums[i], all.weight, all.sum);
}

HWY_FLATTEN void find_cells(const double* column, std::size_t count, const double (&low_width_last)[3],
                            std::int32_t* cells) {
  const Lanes low = Lanes::fill(low_width_last[0]), width = Lanes::fill(low_width_last[1]),
              last = Lanes::fill(low_width_last[2]);
  for (std::size_t i = 0; i < count; i += kLanes)
    smaller((Lanes::load(column + i) - low) / width, last).store(cells + i);
}

HWY_INLINE Lanes distance(const Points& points, int seed, int row) {
  const Lanes x = Lanes::fill(points(seed, 0)) - Lanes::load(points.col(0).data() + row),
              y = Lanes::fill(points(seed, 1)) - Lanes::load(points.col(1).data() + row),
              z = Lanes::fill(points(seed, 2)) - Lanes::load(points.col(2).data() + row);
  return square_root(x * x + y * y + z * z);
}

HWY_FLATTEN void compare_with_seed(const CorrespondenceSet& matches, int seed, double tolerance, std::uint8_t* agrees) {
  const Points &p = matches.source_points, &q = matches.target_points;
  const Lanes yes = Lanes::fill(1), no = Lanes::fill(0), limit = Lanes::fill(tolerance);
  int row = 0;
  for (; row + kLanes <= matches.size(); row += kLanes)
    select(magnitude(distance(p, seed, row) - distance(q, seed, row)) < limit, yes, no).store(agrees + row);
  for (; row < matches.size(); ++row)
    agrees[row] = std::abs(point_distance(p, seed, row) - point_distance(q, seed, row)) < tolerance;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(divide_columns);
HWY_EXPORT(between_class_variances);
HWY_EXPORT(find_cells);
HWY_EXPORT(compare_with_seed);

void divide_columns(const double* first, const double* second, std::size_t count, double* ratios) {
  HWY_DYNAMIC_DISPATCH(divide_columns)(first, second, count, ratios);
}

void between_class_variances(const double* lower_weights, const double* lower_sums, const ClassSums& all,
                             std::size_t count, double* variances) {
  HWY_DYNAMIC_DISPATCH(between_class_variances)(lower_weights, lower_sums, all, count, variances);
}

void find_cells(const double* column, std::size_t count, const double (&low_width_last)[3], std::int32_t* cells) {
  HWY_DYNAMIC_DISPATCH(find_cells)(column, count, low_width_last, cells);
}

void compare_with_seed(const CorrespondenceSet& matches, int seed, double tolerance, std::uint8_t* agrees) {
  HWY_DYNAMIC_DISPATCH(compare_with_seed)(matches, seed, tolerance, agrees);
}

}  // namespace corral
#endif
