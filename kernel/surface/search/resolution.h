// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// Point resolution pr of a surface in mesh units: the mean distance of a vertex to its nearest other vertex. Exact
/// duplicates of a vertex count once. This is not the mean edge length, which is about 1.5 pr.
///
/// Source    [yang2017evaluation], and the authors' program (k = 2 nearest neighbours, averaged).
/// Cost      O(V) time where vertices lie evenly on a surface. Any number of threads gives the same bits.
/// Throws    InvalidInput for fewer than two distinct vertices.
/// Plain form  tests/support/reference_surface.h
double point_resolution(const Points& vertices, const ParallelFor& parallel = one_by_one);

}  // namespace corral
