// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/surface/mesh/topology.h"

namespace corral::testing {

/// From a list of the triangles of each edge, as slowly as it is defined.
Topology reference_topology(const Mesh& mesh);

/// From the half-edges of all of a mesh, by OpenMesh.
std::vector<Indices> reference_rings(const Mesh& mesh);

}  // namespace corral::testing
