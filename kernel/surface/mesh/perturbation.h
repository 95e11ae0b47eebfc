// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A copy of the mesh with independent normal noise of the given deviation (mesh units) on every coordinate. The triangles
/// stay, so that vertex i of the copy is vertex i of the mesh.
///
/// Source    [yang2017evaluation].
/// Throws    InvalidInput if the deviation is not finite and >= 0.
Mesh add_gaussian_noise(const Mesh& mesh, double deviation, std::uint64_t seed);

/// The standard deviation of the noise between two meshes: root mean square of the differences of all coordinates, vertex by
/// vertex.
/// Throws    InvalidInput unless both have the same number of vertices, at least one.
double noise_deviation(const Mesh& clean, const Mesh& noisy);

/// A random share of the vertices, round(share V) of them, chosen uniformly, in their order. Each corner of a triangle moves
/// to the kept vertex nearest to it along edges (equally near: the lower vertex); a triangle with two corners at the same
/// vertex is dropped. The remaining triangles keep their winding, and with it the outside of the surface.
///
/// Throws    InvalidInput unless 0 <= share <= 1.
Mesh thin_mesh(const Mesh& mesh, double share, std::uint64_t seed);

/// The mesh under a rigid motion.
Mesh move_mesh(const Mesh& mesh, const RigidTransform& target_from_source);

/// A motion that turns the mesh about its centroid by a uniformly random rotation and shifts it by its bounding-box
/// diagonal in a random direction.
RigidTransform random_motion(const Mesh& mesh, std::uint64_t seed);

}  // namespace corral
