// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "kernel/types.h"

namespace corral {

/// Three vertices per row, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3>;

/// A triangle mesh, or a point cloud if it has no triangles. Plain arrays: code that needs half-edges or a tree builds them.
struct Mesh {
  Points vertices;                             ///< V x 3, mesh units
  Triangles triangles;                         ///< F x 3, zero-based rows of `vertices`; F = 0 for a cloud
  Points normals = {};                         ///< V x 3, of any length, zero where unknown; or no rows: none are known
  std::optional<Eigen::Vector3d> sensor = {};  ///< from where the surface was seen, mesh units, if that is known

  /// Throws InvalidInput if a coordinate is not finite, a triangle names a vertex that does not exist, or there are normals
  /// but not one for each vertex.
  void validate(const std::string& who) const;
};

/// Rows in ascending order of x, then y, then z, then row: the numbering of the points matters only among coincident ones.
Indices rows_by_place(const Points& points);

/// Mean of all vertices; zero for none.
Eigen::Vector3d vertex_centroid(const Mesh& mesh);

/// Sum over the triangles around each vertex of their normals weighted by area, V x 3 (squared mesh units, not unit
/// length); zero for a vertex without triangles.
Points area_weighted_normals(const Mesh& mesh);

}  // namespace corral
