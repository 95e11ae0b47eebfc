// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace corral {

/// Whether so many numbers are neither infinite nor NaN: one pass at the speed of memory.
bool all_finite(const double* numbers, Eigen::Index count);

}  // namespace corral
