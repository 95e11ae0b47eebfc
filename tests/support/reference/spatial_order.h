// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/types.h"

namespace corral::testing {

/// Whether an order of points is what the definition of spatial_order() makes of them. Which of several equal points come
/// first, and the order of the eight in a leaf, are left open.
bool is_spatial_order(const Points& points, const Indices& order);

}  // namespace corral::testing
