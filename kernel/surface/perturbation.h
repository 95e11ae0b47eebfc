// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh.h"

namespace corral {

/// A copy of the mesh with independent normal noise of the given deviation (mesh units) on every coordinate. The triangles
/// stay, so that vertex i of the copy is vertex i of the mesh.
///
/// Source    [yang2017evaluation].
/// Throws    InvalidInput if the deviation is not finite and >= 0.
Mesh add_gaussian_noise(const Mesh& mesh, double deviation, std::uint64_t seed);

/// The mesh under a rigid motion.
Mesh move_mesh(const Mesh& mesh, const RigidTransform& target_from_source);

/// A motion that turns the mesh about its centroid by a uniformly random rotation and shifts it by its bounding-box
/// diagonal in a random direction.
RigidTransform random_motion(const Mesh& mesh, std::uint64_t seed);

}  // namespace corral
