// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/perturbation.h"

#include <cmath>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/topology.h"

namespace corral {
namespace {

/// `count` of the rows 0 .. rows - 1, ascending: selection sampling, one draw for each row.
Indices random_rows(int rows, int count, std::uint64_t seed) {
  RandomStream random(seed);
  Indices kept;
  for (int row = 0; row < rows; ++row) {
    const auto left = static_cast<std::uint64_t>(rows - row);
    if (random.below(left) < static_cast<std::uint64_t>(count) - kept.size()) kept.push_back(row);
  }
  return kept;
}

/// For each vertex the place in `kept` of the kept vertex that is the fewest edges away; -1 if none can be reached.
Indices nearest_kept(const Mesh& mesh, const Indices& kept) {
  const std::vector<Indices> rings = vertex_rings(mesh);
  Indices owners(rings.size(), -1), front = kept;
  for (std::size_t i = 0; i < kept.size(); ++i) owners[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
  while (!front.empty()) {
    Indices next;  // a front is in the order of its owners, so that the first to arrive is the lowest
    for (const int vertex : front)
      for (const int neighbor : rings[static_cast<std::size_t>(vertex)]) {
        int& owner = owners[static_cast<std::size_t>(neighbor)];
        if (owner >= 0) continue;
        owner = owners[static_cast<std::size_t>(vertex)];
        next.push_back(neighbor);
      }
    front = std::move(next);
  }
  return owners;
}

}  // namespace

Mesh add_gaussian_noise(const Mesh& mesh, double deviation, std::uint64_t seed) {
  if (!(deviation >= 0) || !std::isfinite(deviation))
    throw InvalidInput("add_gaussian_noise", "deviation", deviation, "a finite length of at least 0");
  RandomStream random(seed);
  Mesh noisy{mesh.vertices, mesh.triangles};  // its normals would be those of the clean one
  for (Eigen::Index row = 0; row < noisy.vertices.rows(); ++row)
    for (int axis = 0; axis < 3; ++axis) noisy.vertices(row, axis) += deviation * random.normal();
  return noisy;
}

double noise_deviation(const Mesh& clean, const Mesh& noisy) {
  if (clean.vertices.rows() != noisy.vertices.rows() || clean.vertices.rows() == 0)
    throw InvalidInput("noise_deviation", "number of vertices", std::to_string(noisy.vertices.rows()),
                       "those of the clean mesh, " + std::to_string(clean.vertices.rows()) + ", and at least one");
  return std::sqrt((noisy.vertices - clean.vertices).squaredNorm() / static_cast<double>(clean.vertices.size()));
}

Mesh thin_mesh(const Mesh& mesh, double share, std::uint64_t seed) {
  if (!(share >= 0 && share <= 1)) throw InvalidInput("thin_mesh", "share", share, "0 .. 1");
  const auto rows = static_cast<int>(mesh.vertices.rows());
  const Indices kept = random_rows(rows, static_cast<int>(std::lround(share * rows)), seed);
  const Indices owners = nearest_kept(mesh, kept);
  Indices corners;
  for (Eigen::Index row = 0; row < mesh.triangles.rows(); ++row) {
    const auto owner = [&](int i) { return owners[static_cast<std::size_t>(mesh.triangles(row, i))]; };
    const int a = owner(0), b = owner(1), c = owner(2);
    if (a >= 0 && b >= 0 && c >= 0 && a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
  }
  Mesh thin{mesh.vertices(kept, Eigen::all), {}};
  thin.triangles = Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  return thin;
}

Mesh move_mesh(const Mesh& mesh, const RigidTransform& target_from_source) {
  Mesh moved{target_from_source.apply(mesh.vertices), mesh.triangles,
             mesh.normals * target_from_source.rotation.transpose()};
  if (mesh.sensor) moved.sensor = target_from_source * *mesh.sensor;
  return moved;
}

RigidTransform random_motion(const Mesh& mesh, std::uint64_t seed) {
  RandomStream random(seed);
  RigidTransform motion;
  const Eigen::Vector3d centroid = vertex_centroid(mesh);
  motion.rotation = random.rotation();
  motion.translation =
      centroid - motion.rotation * centroid + bounding_box(mesh.vertices).diagonal() * random.direction();
  return motion;
}

}  // namespace corral
