// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// What a half-edge structure makes of a mesh: its sound triangles (SoundTriangles) are added one by one, in order.
struct HalfEdgeReport {
  int refused_faces = 0;              ///< that it cannot hold: third on an edge, or in a folded fan
  std::optional<int> boundary_loops;  ///< closed walks along boundary edges; absent where faces are refused
  double mean_edge_length = 0;        ///< over the edges of the faces held, mesh units; 0 without triangles
};

HalfEdgeReport inspect_half_edges(const Mesh& mesh);

/// For each of `vertices` vertices those that an edge joins to it, ascending; none for a vertex without a triangle. Triangles
/// that the structure refuses are left out.
std::vector<Indices> half_edge_rings(const Triangles& triangles, Eigen::Index vertices);

}  // namespace corral
