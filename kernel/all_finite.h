// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace corral {

/// Whether so many numbers are neither infinite nor NaN: one pass at the speed of memory.
/// Plain form  tests/support/reference_columns.h
bool all_finite(const double* numbers, Eigen::Index count);

}  // namespace corral
