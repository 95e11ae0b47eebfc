// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/surface/mesh/mesh.h"

namespace corral::testing {

/// A sphere from an icosahedron, each triangle cut in four `levels` times: 10 * 4^levels + 2 vertices.
Mesh icosphere(int levels, double radius = 1.0);

/// A flat grid of columns x rows vertices in the plane z = 0, spacing apart, facing +z.
Mesh grid(int columns, int rows, double spacing = 1.0);

/// A sphere whose radius swells and shrinks irregularly: corners to detect, no symmetry. Seeded.
Mesh bumpy_sphere(int levels, std::uint64_t seed);

}  // namespace corral::testing
