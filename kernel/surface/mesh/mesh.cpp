// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "kernel/error.h"

namespace corral {

void Mesh::validate(const std::string& who) const {
  for (Eigen::Index vertex = 0; vertex < vertices.rows(); ++vertex)
    if (!vertices.row(vertex).allFinite())
      throw InvalidInput(who, "vertex " + std::to_string(vertex), "not finite", "three finite coordinates");
  for (Eigen::Index face = 0; face < triangles.rows(); ++face)
    for (int corner = 0; corner < 3; ++corner)
      if (triangles(face, corner) < 0 || triangles(face, corner) >= vertices.rows())
        throw InvalidInput(who, "face " + std::to_string(face), "of vertex " + std::to_string(triangles(face, corner)),
                           "vertices 0 .. " + std::to_string(vertices.rows() - 1));
  if (normals.rows() > 0 && normals.rows() != vertices.rows())
    throw InvalidInput(who, "normals", std::to_string(normals.rows()),
                       std::to_string(vertices.rows()) + ", one a vertex");
  if (!normals.allFinite()) throw InvalidInput(who, "normals", "not finite", "three finite components each");
}

Indices rows_by_place(const Points& points) {
  Indices rows(static_cast<std::size_t>(points.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  const auto key = [&](int row) { return std::make_tuple(points(row, 0), points(row, 1), points(row, 2), row); };
  std::sort(rows.begin(), rows.end(), [&](int a, int b) { return key(a) < key(b); });
  return rows;
}

Eigen::Vector3d vertex_centroid(const Mesh& mesh) {
  if (mesh.vertices.rows() == 0) return Eigen::Vector3d::Zero();
  return mesh.vertices.colwise().mean().transpose();
}

Points area_weighted_normals(const Mesh& mesh) {
  Points normals = Points::Zero(mesh.vertices.rows(), 3);
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    const Eigen::RowVector3d a = mesh.vertices.row(mesh.triangles(face, 0));
    const Eigen::RowVector3d b = mesh.vertices.row(mesh.triangles(face, 1));
    const Eigen::RowVector3d c = mesh.vertices.row(mesh.triangles(face, 2));
    const Eigen::RowVector3d normal = 0.5 * (b - a).cross(c - a);
    for (int corner = 0; corner < 3; ++corner) normals.row(mesh.triangles(face, corner)) += normal;
  }
  return normals;
}

}  // namespace corral
