// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/simplification.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <unordered_map>

#include "kernel/bounding_box.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kLeastSize = std::numeric_limits<double>::min();  // of a cell, for points in one place

/// The cluster of each vertex, numbered as they first appear.
struct Clusters {
  Indices of_vertex;
  int count = 0;
};

Clusters cluster(const Points& vertices, double size) {
  const Eigen::RowVector3d corner = vertices.colwise().minCoeff();
  Clusters clusters;
  clusters.of_vertex.reserve(static_cast<std::size_t>(vertices.rows()));
  std::unordered_map<std::uint64_t, int> numbers;
  for (Eigen::Index vertex = 0; vertex < vertices.rows(); ++vertex) {
    std::uint64_t key = 0;  // a cell is never smaller than a 2^20th of the extent
    for (int axis = 0; axis < 3; ++axis)
      key = (key << 21) | static_cast<std::uint64_t>((vertices(vertex, axis) - corner(axis)) / size);
    clusters.of_vertex.push_back(numbers.emplace(key, clusters.count).first->second);
    clusters.count = static_cast<int>(numbers.size());
  }
  return clusters;
}

Clusters cluster_to(const Points& vertices, int most_vertices) {
  // The number of cells that a surface meets falls with the square of their size: begin fine, and step by that law.
  const double diagonal = bounding_box(vertices).diagonal();
  double size = std::max({diagonal / std::sqrt(most_vertices) / 3, diagonal / (1 << 20), kLeastSize});
  Clusters clusters = cluster(vertices, size);
  while (clusters.count > most_vertices) {
    size *= std::max(1.02, std::sqrt(static_cast<double>(clusters.count) / most_vertices));
    clusters = cluster(vertices, size);
  }
  return clusters;
}

Triangles coarse_triangles(const Triangles& triangles, const Indices& cluster_of) {
  std::set<std::array<int, 3>> seen;
  std::vector<std::array<int, 3>> kept;
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    std::array<int, 3> corners{};
    for (int corner = 0; corner < 3; ++corner)
      corners[static_cast<std::size_t>(corner)] = cluster_of[static_cast<std::size_t>(triangles(face, corner))];
    std::array<int, 3> key = corners;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] || !seen.insert(key).second) continue;
    kept.push_back(corners);
  }
  Triangles coarse(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t face = 0; face < kept.size(); ++face)
    coarse.row(static_cast<Eigen::Index>(face)) << kept[face][0], kept[face][1], kept[face][2];
  return coarse;
}

/// The sums of the fine normals at unit length; where they cancel, the coarse mesh's own, and else any.
Points unit_normals(const Points& sums, const Points& areas, const Mesh& coarse) {
  const Points own = area_weighted_normals(coarse);
  Points normals(sums.rows(), 3);
  for (Eigen::Index row = 0; row < sums.rows(); ++row) {
    Eigen::RowVector3d normal = sums.row(row);
    if (!(normal.norm() > 0.2 * areas(row, 0))) normal = own.row(row);
    normals.row(row) = normal.norm() > 0 ? Eigen::RowVector3d(normal / normal.norm()) : Eigen::RowVector3d::UnitZ();
  }
  return normals;
}

/// Clustering can reverse slivers: reverses them back, so that every face agrees with the normals of its corners.
void turn_to_normals(Triangles& triangles, const Points& vertices, const Points& normals) {
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    const Eigen::RowVector3d a = vertices.row(triangles(face, 0)), b = vertices.row(triangles(face, 1)),
                             c = vertices.row(triangles(face, 2));
    const Eigen::RowVector3d corners =
        normals.row(triangles(face, 0)) + normals.row(triangles(face, 1)) + normals.row(triangles(face, 2));
    if ((b - a).cross(c - a).dot(corners) < 0) std::swap(triangles(face, 1), triangles(face, 2));
  }
}

}  // namespace

SimplifiedMesh simplify_for_display(const Mesh& mesh, int most_vertices) {
  if (most_vertices < 1)
    throw InvalidInput("simplify_for_display", "most_vertices", std::to_string(most_vertices), "at least 1");
  mesh.validate("simplify_for_display");
  const auto vertices = mesh.vertices.rows();
  Clusters clusters;
  if (vertices > most_vertices) {
    clusters = cluster_to(mesh.vertices, most_vertices);
  } else {
    clusters.count = static_cast<int>(vertices);
    for (int vertex = 0; vertex < clusters.count; ++vertex) clusters.of_vertex.push_back(vertex);
  }
  const Points fine = area_weighted_normals(mesh);
  Points sums = Points::Zero(clusters.count, 3), areas = sums, places = sums;
  Eigen::VectorXd members = Eigen::VectorXd::Zero(clusters.count);
  for (Eigen::Index vertex = 0; vertex < vertices; ++vertex) {
    const int home = clusters.of_vertex[static_cast<std::size_t>(vertex)];
    places.row(home) += mesh.vertices.row(vertex);
    members(home) += 1;
    sums.row(home) += fine.row(vertex);
    areas(home, 0) += fine.row(vertex).norm();
  }
  SimplifiedMesh simplified;
  simplified.mesh.vertices = places.array().colwise() / members.array();
  if (mesh.triangles.rows() == 0) return simplified;
  simplified.mesh.triangles = coarse_triangles(mesh.triangles, clusters.of_vertex);
  simplified.normals = unit_normals(sums, areas, simplified.mesh);
  turn_to_normals(simplified.mesh.triangles, simplified.mesh.vertices, simplified.normals);
  return simplified;
}

}  // namespace corral
