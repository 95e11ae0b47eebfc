// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh/mesh.h"

namespace corral::ours {

/// How many pairs of vertices lie within a radius, by the grid of the hot loops.
double pairs_by_grid(const Mesh& mesh, double radius);

}  // namespace corral::ours
