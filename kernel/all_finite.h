// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace corral {

/// Whether none of `count` numbers is infinite or NaN; one pass at memory speed.
/// Plain form  tests/support/reference/columns.h
bool all_finite(const double* numbers, Eigen::Index count);

}  // namespace corral
