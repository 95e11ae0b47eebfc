// SPDX-License-Identifier: MIT
#include "kernel/surface/perturbation.h"

#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {

Mesh add_gaussian_noise(const Mesh& mesh, double deviation, std::uint64_t seed) {
  if (!(deviation >= 0) || !std::isfinite(deviation))
    throw InvalidInput("add_gaussian_noise", "deviation", deviation, "a finite length of at least 0");
  RandomStream random(seed);
  Mesh noisy = mesh;
  for (Eigen::Index row = 0; row < noisy.vertices.rows(); ++row)
    for (int axis = 0; axis < 3; ++axis) noisy.vertices(row, axis) += deviation * random.normal();
  return noisy;
}

Mesh move_mesh(const Mesh& mesh, const RigidTransform& target_from_source) {
  return {target_from_source.apply(mesh.vertices), mesh.triangles};
}

RigidTransform random_motion(const Mesh& mesh, std::uint64_t seed) {
  RandomStream random(seed);
  RigidTransform motion;
  const Eigen::Vector3d centroid = vertex_centroid(mesh);
  motion.rotation = random.rotation();
  motion.translation =
      centroid - motion.rotation * centroid + bounding_box_diagonal(mesh.vertices) * random.direction();
  return motion;
}

}  // namespace corral
