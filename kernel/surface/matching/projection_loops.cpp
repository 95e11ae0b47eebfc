// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/projection_loops.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/matching/projection_loops.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_INLINE double product(const double* a, const double* b, int count) {
  Lanes even = Lanes::load(a) * Lanes::load(b), odd = Lanes::fill(0);
  int i = kLanes;
  for (; i + kLanes < count; i += 2 * kLanes) {
    odd = odd + Lanes::load(a + i) * Lanes::load(b + i);
    even = even + Lanes::load(a + i + kLanes) * Lanes::load(b + i + kLanes);
  }
  if (i < count) odd = odd + Lanes::load(a + i) * Lanes::load(b + i);
  return sum(even + odd);
}

HWY_FLATTEN void orthonormalise(const Columns<double>& columns) {
  const int length = columns.length;
  for (int k = 0; k < columns.count; ++k) {
    double* column = columns.first + k * length;
    const double before = product(column, column, length);
    for (int other = 0; other < k; ++other) {
      const double* base = columns.first + other * length;
      const Lanes factor = Lanes::fill(product(column, base, length));
      for (int i = 0; i < length; i += kLanes)
        (Lanes::load(column + i) - factor * Lanes::load(base + i)).store(column + i);
    }
    const double after = product(column, column, length);
    const Lanes factor = Lanes::fill(after > 1e-12 * before && after > 1e-200 ? 1 / std::sqrt(after) : 0);
    for (int i = 0; i < length; i += kLanes) (factor * Lanes::load(column + i)).store(column + i);
  }
}

HWY_FLATTEN double orthonormality_defect(const Columns<const double>& columns) {
  const int length = columns.length;
  double squares = 0;
  for (int k = 0; k < columns.count; ++k)
    for (int other = 0; other <= k; ++other) {
      const double value = product(columns.first + k * length, columns.first + other * length, length);
      if (other < k)
        squares += 2 * value * value;
      else if (value > 0)
        squares += (value - 1) * (value - 1);
    }
  return std::sqrt(squares);
}

HWY_FLATTEN void scale_and_round(const Columns<const double>& columns, const double* center, double scale,
                                 float* rounded, double* squared) {
  const int length = columns.length;
  const Lanes factor = Lanes::fill(scale);
  for (int i = 0; i < columns.count; ++i) {
    const double* from = columns.first + i * length;
    float* to = rounded + i * length;
    Lanes squares = factor - factor;
    int row = 0;
    for (; row + kLanes <= length; row += kLanes) {
      const Lanes x = (Lanes::load(from + row) - Lanes::load(center + row)) * factor;
      squares = squares + x * x;
      x.store(to + row);
    }
    squared[i] = sum(squares);
    for (; row < length; ++row) {
      const double x = (from[row] - center[row]) * scale;
      squared[i] += x * x;
      to[row] = static_cast<float>(x);
    }
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(orthonormalise);
HWY_EXPORT(orthonormality_defect);
HWY_EXPORT(scale_and_round);

void orthonormalise(const Columns<double>& columns) { HWY_DYNAMIC_DISPATCH(orthonormalise)(columns); }

double orthonormality_defect(const Columns<const double>& columns) {
  return HWY_DYNAMIC_DISPATCH(orthonormality_defect)(columns);
}

void scale_and_round(const Columns<const double>& columns, const double* center, double scale, float* rounded,
                     double* squared) {
  HWY_DYNAMIC_DISPATCH(scale_and_round)(columns, center, scale, rounded, squared);
}

}  // namespace corral
#endif
