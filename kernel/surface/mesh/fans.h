// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/mesh/sides.h"

namespace corral {

/// Triangles as the half-edges of OpenMesh join them, added one by one in the order of their rows.
struct JoinedTriangles {
  /// For each side the one across its edge, which runs the other way, kNoSide or kLeftOut.
  Indices across;
  /// How many are left out: third on an edge, or in a folded fan.
  int left_out = 0;
  /// For each vertex a side that begins there, one of the boundary if there is, or kNoSide; kManySides where `following` says
  /// how the boundary goes on.
  Indices starts;
  /// Sides of the boundary that end in such a vertex, ascending, each with the one that its loop goes on with.
  std::vector<std::pair<int, int>> following;
};

/// Joins sound triangles that are wound alike as far as they can be; `across` is sides_across() of them.
JoinedTriangles join_triangles(const Triangles& triangles, Indices across, Eigen::Index vertices);

}  // namespace corral
