// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/surface/mesh/mesh.h"
#include "tests/fuzz/target.h"

namespace corral::fuzz {

/// A crooked grid, so that most are surfaces, with some vertices and triangles from anywhere.
template <double (Bytes::*number)()>
Mesh crooked_mesh(Bytes& bytes) {
  Mesh mesh;
  const int width = 2 + bytes.below(7), height = 2 + bytes.below(7);
  mesh.vertices.resize(width * height, 3);
  for (int row = 0; row < mesh.vertices.rows(); ++row) {
    mesh.vertices.row(row) << row % width, row / width, bytes.below(8) / 4.0;
    if (bytes.below(8) == 0)
      for (int axis = 0; axis < 3; ++axis) mesh.vertices(row, axis) = (bytes.*number)();
  }
  const int kind = bytes.below(3);
  std::vector<std::array<int, 3>> triangles;
  for (int row = 0; kind > 0 && row + width + 1 < mesh.vertices.rows(); ++row) {
    if (row % width + 1 == width) continue;
    triangles.push_back({row, row + 1, row + width});
    triangles.push_back({row + 1, row + width + 1, row + width});
  }
  const int vertices = static_cast<int>(mesh.vertices.rows());
  for (int more = kind == 2 ? bytes.below(60) : 0; more > 0; --more)
    triangles.push_back({bytes.below(vertices), bytes.below(vertices), bytes.below(vertices)});
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      mesh.triangles(static_cast<Eigen::Index>(i), corner) = triangles[i][static_cast<std::size_t>(corner)];
  return mesh;
}

}  // namespace corral::fuzz
