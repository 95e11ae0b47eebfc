// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A coarse mesh for display, with the normals of the fine one.
struct SimplifiedMesh {
  Mesh mesh;
  Points normals;  ///< V x 3, unit length; empty for a cloud
};

/// The vertices in each cell of a cubic grid are replaced by their mean; the cell size is the smallest of a series that
/// leaves at most `most_vertices`. A mesh with no more vertices keeps them. Triangles that lose a corner or coincide with
/// another are dropped; those that face against the normals of their corners are reversed. Normals are the area-weighted
/// sums of those of the fine vertices; where these cancel (thin sheets), those of the coarse mesh.
///
/// Cost      O(V + F) time and memory for each size tried, about ten. Deterministic.
/// Throws    InvalidInput: most_vertices below 1, an invalid mesh.
SimplifiedMesh simplify_for_display(const Mesh& mesh, int most_vertices);

}  // namespace corral
