// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// The connectivity of a mesh, as its edges tell it; half_edges.h says what a half-edge structure makes of it.
struct Topology {
  int duplicate_vertices = 0;     ///< vertices at exactly the place of an earlier one
  int isolated_vertices = 0;      ///< vertices without a triangle (in a mesh that has triangles)
  int degenerate_faces = 0;       ///< triangles with a repeated corner or without area
  int misoriented_faces = 0;      ///< triangles wound against the majority of their part
  int non_manifold_edges = 0;     ///< edges with more than two triangles
  int non_manifold_vertices = 0;  ///< vertices whose triangles are not one fan wound alike
  int components = 0;             ///< parts of the triangles that share no vertex
  int boundary_edges = 0;         ///< edges with one triangle
};

/// Degenerate triangles are counted and left out of what follows them; misoriented ones are counted and reversed.
Topology inspect_topology(const Mesh& mesh);

/// For each vertex the vertices that an edge joins to it, ascending; none for a vertex without a triangle. Degenerate triangles
/// and those that a half-edge structure refuses are left out, however they are wound.
std::vector<Indices> vertex_rings(const Mesh& mesh);

/// The points without exact duplicates, in ascending order of x, then y, then z.
Points distinct_points(const Points& points);

}  // namespace corral
