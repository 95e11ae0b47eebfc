// SPDX-License-Identifier: MIT
#include "tests/support/object_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kernel/random.h"
#include "tests/support/meshes.h"

namespace corral::testing {
namespace {

constexpr double kDistance = 8;     // of the sensor from an object of radius 2
constexpr double kFlattest = 0.25;  // cosine at which a vertex is still seen
constexpr double kShare = 0.8;      // of the vertices that are seen
constexpr double kNoise = 0.002;
constexpr double kCell = 0.06;    // of the image in which nearer vertices hide others
constexpr double kBehind = 0.25;  // depth that slope explains within a cell

struct Surface {
  Points vertices, normals;
};

/// Bumpy balls of several sizes that stick in each other: nothing about it repeats.
Surface figure(std::uint64_t seed) {
  RandomStream random(seed);
  Surface surface{Points(0, 3), Points(0, 3)};
  for (int ball = 0; ball < 6; ++ball) {
    Mesh mesh = bumpy_sphere(ball == 0 ? 5 : 4, seed * 10 + static_cast<std::uint64_t>(ball));
    mesh.vertices *= ball == 0 ? 0.9 : random.uniform(0.3, 0.55);
    if (ball > 0) {
      const Eigen::RowVector3d outwards = random.direction().transpose();
      mesh.vertices.rowwise() += random.uniform(0.8, 1.3) * outwards;
    }
    const Eigen::Index before = surface.vertices.rows();
    surface.vertices.conservativeResize(before + mesh.vertices.rows(), 3);
    surface.normals.conservativeResize(before + mesh.vertices.rows(), 3);
    surface.vertices.bottomRows(mesh.vertices.rows()) = mesh.vertices;
    surface.normals.bottomRows(mesh.vertices.rows()) = area_weighted_normals(mesh).rowwise().normalized();
  }
  return surface;
}

/// Rows that a sensor at the origin sees: they look at it, and none is in front of them.
Indices seen(const Points& vertices, const Points& normals, RandomStream& random) {
  std::map<std::pair<double, double>, double> nearest;
  const auto cell = [&](Eigen::Index row) {
    const double scale = kDistance / vertices(row, 2) / kCell;
    return std::pair(std::floor(vertices(row, 0) * scale), std::floor(vertices(row, 1) * scale));
  };
  for (Eigen::Index row = 0; row < vertices.rows(); ++row) {
    const auto [place, is_first] = nearest.try_emplace(cell(row), vertices.row(row).norm());
    if (!is_first) place->second = std::min(place->second, vertices.row(row).norm());
  }
  Indices rows;
  for (Eigen::Index row = 0; row < vertices.rows(); ++row) {
    const double depth = vertices.row(row).norm();
    if (-normals.row(row).dot(vertices.row(row)) > kFlattest * depth && depth < nearest[cell(row)] + kBehind &&
        random.uniform() < kShare)
      rows.push_back(static_cast<int>(row));
  }
  return rows;
}

}  // namespace

RigidTransform ObjectViews::between(int a, int b) const {
  return world_from_view[static_cast<std::size_t>(b)].inverse() * world_from_view[static_cast<std::size_t>(a)];
}

ObjectViews object_views(int count, std::uint64_t seed) {
  const Surface object = figure(seed);
  RandomStream random(seed);
  ObjectViews made;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.141592653589793 * i / count;
    const Eigen::Vector3d place(kDistance * std::cos(angle), kDistance * std::sin(angle), 0);
    // The sensor looks along -z, tilted about that by any angle.
    RigidTransform world;
    world.rotation = Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitZ(), -place).toRotationMatrix() *
                     Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    world.translation = place;
    const Points vertices = world.inverse().apply(object.vertices), normals = object.normals * world.rotation;
    Mesh view{vertices(seen(vertices, normals, random), Eigen::all), Triangles(0, 3)};
    for (Eigen::Index row = 0; row < view.vertices.rows(); ++row)
      for (int axis = 0; axis < 3; ++axis) view.vertices(row, axis) += kNoise * random.normal();
    made.views.push_back(std::move(view));
    made.world_from_view.push_back(world);
  }
  return made;
}

}  // namespace corral::testing
