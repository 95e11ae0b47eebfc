// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "kernel/vectorized.h"

namespace corral {

// The one place where the distance of two features is defined. Only sources include this, compiled without contraction.

/// The squared distance: rows in sixteen sums by row mod 16, the first eight and the last eight added, then lanes::sum.
template <class Lanes>
CORRAL_INLINE double squared_distance(const double* a, const double* b, Eigen::Index rows) {
  Lanes even = Lanes::fill(0), odd = even;
  const auto add = [&](const double* x, const double* y) {
    const Lanes first = Lanes::load(x) - Lanes::load(y), second = Lanes::load(x + kLanes) - Lanes::load(y + kLanes);
    even = even + first * first;
    odd = odd + second * second;
  };
  Eigen::Index row = 0;
  for (; row + 2 * kLanes <= rows; row += 2 * kLanes) add(a + row, b + row);
  if (row < rows) {
    double rest[2][2 * kLanes] = {};
    std::copy(a + row, a + rows, rest[0]);
    std::copy(b + row, b + rows, rest[1]);
    add(rest[0], rest[1]);
  }
  return sum(even + odd);
}

/// The two nearest of the columns that were offered, in any order, each once.
struct TwoNearest {
  int column = std::numeric_limits<int>::max();
  double squared = std::numeric_limits<double>::infinity();
  double second_squared = std::numeric_limits<double>::infinity();

  void offer(int other, double value) {
    if (value < squared || (value == squared && other < column))
      second_squared = squared, squared = value, column = other;
    else if (value < second_squared)
      second_squared = value;
  }
};

}  // namespace corral
