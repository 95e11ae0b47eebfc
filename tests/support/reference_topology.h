// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/surface/mesh/topology.h"

namespace corral::testing {

// The half-edges of all of a mesh, by OpenMesh: what they say of it is the definition of Topology and of its rings.

Topology reference_topology(const Mesh& mesh);
std::vector<Indices> reference_rings(const Mesh& mesh);

}  // namespace corral::testing
