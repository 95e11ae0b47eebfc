// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/neighborhood.h"
#include "kernel/surface/search/resolution.h"

namespace corral {

/// What decides to which side normals point.
enum class NormalSide {
  Auto,    ///< the sensor, if the caller names its place; else the first of faces, normals and sensor that the mesh has
  Mesh,    ///< the faces; of a cloud the sensor
  File,    ///< the normals that the mesh has
  Origin,  ///< the sensor, as the authors of [yang2017evaluation] ran it
};
constexpr std::array<const char*, 4> choice_names(NormalSide) { return {"auto", "mesh", "file", "origin"}; }

struct NormalOptions {
  int neighbors = 20;  ///< k nearest vertices, the vertex itself among them
  NormalSide side = NormalSide::Auto;
  std::optional<Eigen::Vector3d> sensor = {};  ///< mesh units; of Mesh and Origin at the origin, if it is not named
};

/// What the normals of a surface follow.
enum class NormalGuide {
  Faces,        ///< the area-weighted sum of the face normals
  Normals,      ///< the normals that the mesh has
  NamedSensor,  ///< towards the sensor that the options name
  OwnSensor,    ///< towards the sensor of the mesh
  Origin,       ///< towards the origin
};
/// Throws InvalidInput if the mesh has no normals, but they are asked for.
NormalGuide normal_guide(const Mesh& mesh, const NormalOptions& options);

/// Unit normals, V x 3: the direction of least variance of the k nearest vertices, on the side of its guide, or where that
/// is zero, towards the sensor. A row is zero where there are fewer than 3 distinct neighbours, or all lie on one line.
///
/// Source    [rusu2009thesis]; k = 20 after the program of [yang2017evaluation].
/// Cost      O(V) time where vertices lie evenly on a surface. Any number of threads gives the same bits.
/// Departs   The authors turn every normal towards the origin, which on closed models gives neighbours opposite signs; with
///           faces the normals follow them, on a noisy mesh its own noisy faces.
/// Throws    InvalidInput for fewer than 3 neighbours, and as normal_guide does.
/// Plain form  tests/support/reference/surface.h
Points estimate_normals(const Mesh& mesh, const NormalOptions& options = {}, const ParallelFor& parallel = one_by_one);

struct NormalsAndResolution {
  Points normals;
  PointSpacing spacing;
};

/// estimate_normals() and point_spacing() by one search for neighbours, to the same bits. Throws what either throws.
NormalsAndResolution estimate_normals_and_resolution(const Mesh& mesh, const NormalOptions& options = {},
                                                     const ParallelFor& parallel = one_by_one);

}  // namespace corral
