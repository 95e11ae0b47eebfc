// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// Where a ray first meets a surface.
struct RayHit {
  int triangle;     ///< row of Mesh::triangles
  double distance;  ///< from the origin of the ray, mesh units
  double cosine;    ///< of the angle between the ray and the normal of the triangle, in 0 .. 1
};

/// The triangles of a mesh, indexed for queries with rays and with other triangles (CGAL's tree of boxes inside, with exact
/// decisions: no ray passes between two triangles that share an edge). Triangles without area are left out. Queries may
/// come from several threads at once.
class SurfaceTree {
 public:
  /// Throws InvalidInput as Mesh::validate does, or if no triangle has an area.
  explicit SurfaceTree(Mesh mesh);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;

  const Mesh& mesh() const;

  /// The first triangle on the ray from `origin` along `direction` (a unit vector); either side of it counts.
  std::optional<RayHit> first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// True if a triangle of `other`, in the frame of this mesh, has a point in common with one of this mesh. A surface that
  /// lies wholly inside a closed one does not meet it.
  bool meets(const Mesh& other) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace corral
