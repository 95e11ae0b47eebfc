// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/heap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"

namespace corral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Eigen::Index kVertices = 1500;  // of a mesh, tested for contact with others
constexpr int kSides = 8;                 // random sides of an object; it rests on the one on which it is lowest
constexpr int kWays = 4;                  // into the heap
constexpr double kFromAbove = 0.3;        // share of the ways that lead down

/// Some vertices of a surface, in the world.
Points sample(const PosedSurface& posed) {
  const Points& vertices = posed.surface->mesh().vertices;
  const Eigen::Index step = std::max<Eigen::Index>(1, vertices.rows() / kVertices);
  return posed.world_from_mesh.apply(vertices(Eigen::seq(0, Eigen::last, step), Eigen::all));
}

/// The shortest way along a direction from one of the points, all in the world, to a surface.
double shortest_way(const Points& points, const PosedSurface& to, const Eigen::Vector3d& direction) {
  const RigidTransform mesh_from_world = to.world_from_mesh.inverse();
  const Points from = mesh_from_world.apply(points);
  const Eigen::Vector3d along = mesh_from_world.rotation * direction;
  double shortest = kInfinity;
  for (Eigen::Index row = 0; row < from.rows(); ++row)
    if (const auto hit = to.surface->first_hit(from.row(row).transpose(), along))
      shortest = std::min(shortest, hit->distance);
  return shortest;
}

/// The side on which an object rests: of some random ones the one on which its middle is lowest above the floor.
Eigen::Matrix3d low_side(const Mesh& mesh, RandomStream& random) {
  const Eigen::Vector3d middle = vertex_centroid(mesh);
  Eigen::Matrix3d lowest;
  double height = kInfinity;
  for (int side = 0; side < kSides; ++side) {
    const Eigen::Matrix3d rotation = random.rotation();
    const double above = rotation.row(2).dot(middle) - (mesh.vertices * rotation.row(2).transpose()).minCoeff();
    if (above < height) height = above, lowest = rotation;
  }
  return lowest;
}

/// Where an object comes from and which way.
struct Way {
  PosedSurface start;
  Eigen::Vector3d direction;
  double length;
};

/// A random way of an object to the middle of the floor: down from above or along the floor.
Way random_way(PosedSurface object, const PosedSurfaces& standing, RandomStream& random) {
  const double size = bounding_box(object.surface->mesh().vertices).diagonal(), far = 100 * size;
  const double angle = random.uniform(0, 2 * std::acos(-1.0)), aside = random.uniform(-0.35, 0.35) * size;
  const Eigen::Vector3d outwards(std::cos(angle), std::sin(angle), 0), across(-std::sin(angle), std::cos(angle), 0);
  const bool from_above = random.uniform() < kFromAbove;
  const Eigen::Vector3d direction = from_above ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(-outwards);
  object.world_from_mesh.translation += aside * across - far * direction;
  if (from_above) object.world_from_mesh.translation += random.uniform(0.2, 0.6) * size * outwards;
  const double path = free_path(object, standing, direction);
  return {object, direction, from_above ? std::min(path, far) : path};
}

bool touches_any(const PosedSurface& object, const PosedSurfaces& standing) {
  return std::any_of(standing.begin(), standing.end(), [&](const PosedSurface& other) { return touch(object, other); });
}

/// Moves an object along its way up to the gap, and back if that is still too close.
PosedSurface arrive(const Way& way, const PosedSurfaces& standing, double gap) {
  PosedSurface object = way.start;
  for (double back = gap;; back *= 2) {
    object.world_from_mesh.translation = way.start.world_from_mesh.translation + (way.length - back) * way.direction;
    if (!touches_any(object, standing)) return object;
  }
}

/// The middle of an object in the world.
Eigen::Vector3d middle(const PosedSurface& object) {
  return object.world_from_mesh * vertex_centroid(object.surface->mesh());
}

PosedSurface add_object(const SurfaceTree& surface, const PosedSurfaces& standing, double gap, RandomStream& random) {
  PosedSurface object{&surface, {}};
  Way best{object, Eigen::Vector3d::Zero(), kInfinity};
  double nearest = kInfinity;
  while (!(nearest < kInfinity))  // ways that miss the heap do not count
    for (int i = 0; i < kWays; ++i) {
      object.world_from_mesh = {low_side(surface.mesh(), random), Eigen::Vector3d::Zero()};
      const Eigen::Vector3d at = middle(object);
      const double lowest = object.world_from_mesh.apply(surface.mesh().vertices).col(2).minCoeff();
      object.world_from_mesh.translation = {-at.x(), -at.y(), -lowest};
      if (standing.empty()) return object;
      const Way way = random_way(object, standing, random);
      const double distance = (middle(way.start) + way.length * way.direction).norm();
      if (distance < nearest) nearest = distance, best = way;
    }
  return arrive(best, standing, gap);
}

}  // namespace

bool touch(const PosedSurface& a, const PosedSurface& b) {
  return a.surface->meets(move_mesh(b.surface->mesh(), a.world_from_mesh.inverse() * b.world_from_mesh));
}

double free_path(const PosedSurface& moving, const PosedSurfaces& standing, const Eigen::Vector3d& direction) {
  const Points ahead = sample(moving);
  double path = kInfinity;
  for (const PosedSurface& other : standing) {
    path = std::min(path, shortest_way(ahead, other, direction));
    path = std::min(path, shortest_way(sample(other), moving, -direction));
  }
  return path;
}

std::vector<RigidTransform> heap(const std::vector<const SurfaceTree*>& objects, double gap, std::uint64_t seed) {
  require_positive("heap", "gap", gap);
  RandomStream random(seed);
  PosedSurfaces standing;
  for (const SurfaceTree* object : objects) standing.push_back(add_object(*object, standing, gap, random));
  std::vector<RigidTransform> poses;
  for (const PosedSurface& object : standing) poses.push_back(object.world_from_mesh);
  return poses;
}

}  // namespace corral
