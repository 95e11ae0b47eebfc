// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh/mesh.h"

namespace corral {

// Side i F + f of a mesh of F triangles runs from corner i of triangle f to its next one: where the corner is in `triangles`.
// No triangle repeats a corner.

constexpr int kNoSide = -1;     ///< no other triangle has this edge
constexpr int kManySides = -2;  ///< more than one other triangle has it

/// For each side that of the triangle across its edge, or one of the two above, however the triangles are wound.
Indices sides_across(const Triangles& triangles, Eigen::Index vertices);

/// The triangles of each part that are wound against its majority; parts join across edges of two triangles.
Indices wound_against_majority(const Triangles& triangles, const Indices& across);

/// What Topology says of triangles that are all sound: every edge has one of them or two, wound alike, and those around a
/// vertex form one fan.
struct SoundEdges {
  bool is_sound = false;
  int components = 0, boundary_edges = 0, boundary_loops = 0;
  double mean_edge_length = 0;  ///< summed in the order in which the triangles first name the edges
};
SoundEdges inspect_edges(const Points& vertices, const Triangles& triangles, const Indices& across);

}  // namespace corral
