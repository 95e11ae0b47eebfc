// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/types.h"

namespace corral {

/// The rows of points (N x 3) as the leaves of a balanced tree: each eight in a row lie in one place, so do eight such
/// eights, and so on. Every part is cut across the longest side of its box. Rows that are not finite come last.
///
/// Cost      O(N log N).
/// Plain form  tests/support/reference_spatial_order.h
Indices spatial_order(const Points& points, const ParallelFor& parallel = one_by_one);

}  // namespace corral
