// SPDX-License-Identifier: MIT
#pragma once

// Passes over columns of numbers once more, one number after the other.

#include <algorithm>
#include <cmath>

#include "kernel/bounding_box.h"

namespace corral::testing {

inline bool reference_all_finite(const double* numbers, Eigen::Index count) {
  return std::all_of(numbers, numbers + count, [](double number) { return std::isfinite(number); });
}

inline Extent reference_extent(const double* numbers, Eigen::Index count) {
  return {*std::min_element(numbers, numbers + count), *std::max_element(numbers, numbers + count)};
}

}  // namespace corral::testing
