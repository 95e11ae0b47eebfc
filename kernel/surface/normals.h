// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/neighborhood.h"

namespace corral {

struct NormalOptions {
  int neighbors = 20;         ///< k nearest vertices, the vertex itself among them
  bool side_of_faces = true;  ///< false: every normal towards the sensor, as the authors of [yang2017evaluation] ran it
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  ///< mesh units
};

/// Unit normals, V x 3: the direction of least variance of the k nearest vertices, oriented by the area-weighted sum of the
/// face normals where that is not zero, else towards the sensor. A row is zero where there are fewer than 3 distinct
/// neighbours, or all lie on one line.
///
/// Source    [rusu2009thesis]; k = 20 after the program of [yang2017evaluation].
/// Cost      O(V) time where vertices lie evenly on a surface. Any number of threads gives the same bits.
/// Departs   The authors turn every normal towards the origin, which on closed models gives neighbours opposite signs; with
///           faces the normals follow them, on a noisy mesh its own noisy faces.
/// Throws    InvalidInput for fewer than 3 neighbours.
/// Plain form  tests/support/reference_surface.h
Points estimate_normals(const Mesh& mesh, const NormalOptions& options = {}, const ParallelFor& parallel = one_by_one);

struct NormalsAndResolution {
  Points normals;
  double resolution;
};

/// estimate_normals() and point_resolution() by one search for neighbours, to the same bits. Throws what either throws.
NormalsAndResolution estimate_normals_and_resolution(const Mesh& mesh, const NormalOptions& options = {},
                                                     const ParallelFor& parallel = one_by_one);

}  // namespace corral
