// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/types.h"

namespace corral {

/// The rows of points (N x 3) in the order of the leaves of a balanced tree: eight consecutive rows lie close together, so
/// do eight such groups of eight, and so on. Each part is split across the longest side of its box. Rows that are not
/// finite come last.
///
/// Cost      O(N log N).
/// Plain form  tests/support/reference/spatial_order.h
Indices spatial_order(const Points& points, const ParallelFor& parallel = one_by_one);

}  // namespace corral
