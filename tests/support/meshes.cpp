// SPDX-License-Identifier: MIT
#include "tests/support/meshes.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "kernel/random.h"

namespace corral::testing {
namespace {

/// Cuts every triangle in four; the new vertices halve the edges.
Mesh subdivided(const Mesh& mesh) {
  std::vector<Eigen::RowVector3d> vertices;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row) vertices.emplace_back(mesh.vertices.row(row));
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
    if (is_new)
      vertices.emplace_back((vertices[static_cast<std::size_t>(a)] + vertices[static_cast<std::size_t>(b)]) / 2);
    return found->second;
  };
  Mesh finer;
  finer.triangles.resize(4 * mesh.triangles.rows(), 3);
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    const int a = mesh.triangles(face, 0), b = mesh.triangles(face, 1), c = mesh.triangles(face, 2);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.triangles.row(4 * face) << a, ab, ca;
    finer.triangles.row(4 * face + 1) << ab, b, bc;
    finer.triangles.row(4 * face + 2) << ca, bc, c;
    finer.triangles.row(4 * face + 3) << ab, bc, ca;
  }
  finer.vertices.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) finer.vertices.row(static_cast<Eigen::Index>(i)) = vertices[i];
  return finer;
}

}  // namespace

Mesh icosphere(int levels, double radius) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  mesh.vertices.resize(12, 3);
  mesh.vertices << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0, -1, g, 0, 1,
      -g, 0, -1, -g, 0, 1;
  mesh.triangles.resize(20, 3);
  mesh.triangles << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,
      9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
  mesh.vertices.rowwise().normalize();
  mesh.vertices *= radius;
  return mesh;
}

Mesh grid(int columns, int rows, double spacing) {
  Mesh mesh;
  mesh.vertices.resize(columns * rows, 3);
  mesh.triangles.resize(2 * (columns - 1) * (rows - 1), 3);
  Eigen::Index face = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int here = row * columns + column;
      mesh.vertices.row(here) << column * spacing, row * spacing, 0;
      if (column + 1 == columns || row + 1 == rows) continue;
      mesh.triangles.row(face++) << here, here + 1, here + columns + 1;
      mesh.triangles.row(face++) << here, here + columns + 1, here + columns;
    }
  return mesh;
}

Mesh bumpy_sphere(int levels, std::uint64_t seed) {
  Mesh mesh = icosphere(levels);
  RandomStream random(seed);
  std::vector<std::pair<Eigen::Vector3d, double>> bumps;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d direction = random.direction();
    bumps.emplace_back(direction, random.uniform(-0.25, 0.35));
  }
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row) {
    const Eigen::Vector3d direction = mesh.vertices.row(row).transpose();
    double radius = 1;
    for (const auto& [centre, height] : bumps) radius += height * std::exp(-(direction - centre).squaredNorm() / 0.02);
    mesh.vertices.row(row) *= radius;
  }
  return mesh;
}

}  // namespace corral::testing
