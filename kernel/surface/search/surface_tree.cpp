// SPDX-License-Identifier: MIT
#include "kernel/surface/search/surface_tree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kernel/error.h"

namespace corral {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Eigen::Vector3d corner(const Mesh& mesh, Eigen::Index face, int which) {
  return mesh.vertices.row(mesh.triangles(face, which)).transpose();
}

/// The triangles that have an area, and in `rows` which they are.
Faces faces_of(const Mesh& mesh, Indices& rows) {
  Faces faces;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    const Kernel::Triangle_3 triangle(to_cgal(corner(mesh, face, 0)), to_cgal(corner(mesh, face, 1)),
                                      to_cgal(corner(mesh, face, 2)));
    if (triangle.is_degenerate()) continue;
    faces.push_back(triangle);
    rows.push_back(static_cast<int>(face));
  }
  return faces;
}

/// Where a ray meets a triangle that it is known to meet: never beyond the corners, however thin the triangle or flat the
/// ray. In a triangle that is seen edge-on it is the nearest corner.
RayHit meet(const Mesh& mesh, int face, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d a = corner(mesh, face, 0), b = corner(mesh, face, 1), c = corner(mesh, face, 2);
  const Eigen::Vector3d along(direction.dot(a - origin), direction.dot(b - origin), direction.dot(c - origin));
  const double nearest = std::max(along.minCoeff(), 0.0), farthest = along.maxCoeff();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double slope = normal.dot(direction), distance = normal.dot(a - origin) / slope;
  // Not std::clamp: without a slope the distance may be no number.
  return {face, distance > nearest ? std::min(distance, farthest) : nearest, std::abs(slope) / normal.norm()};
}

}  // namespace

struct SurfaceTree::Tree {
  Mesh mesh;
  Indices rows;
  Faces faces;
  Boxes boxes;

  explicit Tree(Mesh input) : mesh(std::move(input)), faces(faces_of(mesh, rows)), boxes(faces.begin(), faces.end()) {
    boxes.build();  // not in the first query, which others may run beside
  }

  int row(Faces::const_iterator face) const { return rows[static_cast<std::size_t>(face - faces.begin())]; }
};

SurfaceTree::SurfaceTree(Mesh mesh) {
  mesh.validate("SurfaceTree");
  tree_ = std::make_unique<Tree>(std::move(mesh));
  if (tree_->faces.empty())
    throw InvalidInput("SurfaceTree", "triangles with an area", "0", "at least 1 (a point cloud has no surface)");
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;

const Mesh& SurfaceTree::mesh() const { return tree_->mesh; }

std::optional<RayHit> SurfaceTree::first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const Kernel::Ray_3 ray(to_cgal(origin), Kernel::Vector_3(direction.x(), direction.y(), direction.z()));
  const auto found = tree_->boxes.first_intersected_primitive(ray);
  if (!found) return std::nullopt;
  return meet(tree_->mesh, tree_->row(*found), origin, direction);
}

bool SurfaceTree::meets(const Mesh& other) const {
  Indices unused;
  for (const Kernel::Triangle_3& face : faces_of(other, unused))
    if (tree_->boxes.do_intersect(face)) return true;
  return false;
}

}  // namespace corral
