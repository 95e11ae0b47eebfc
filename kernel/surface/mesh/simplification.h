// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A coarse mesh to look at, with normals that remember the fine one.
struct SimplifiedMesh {
  Mesh mesh;
  Points normals;  ///< V x 3, unit length; empty for a cloud
};

/// Vertices in one cell of a cubic grid become their mean, its cells the smallest of a row of sizes that leave at most
/// `most_vertices`; the vertices of a smaller mesh stay. Triangles that lose a corner, or come to lie on another, go;
/// those that look against the normals of their corners are turned. Normals are the sums of those of the fine vertices,
/// weighted by area; where they cancel (thin sheets) those of the coarse mesh.
///
/// Cost      O(V + F) time and memory for each size tried, about ten. Deterministic.
/// Throws    InvalidInput: most_vertices below 1, an invalid mesh.
SimplifiedMesh simplify_for_display(const Mesh& mesh, int most_vertices);

}  // namespace corral
