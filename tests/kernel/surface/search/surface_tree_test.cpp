// SPDX-License-Identifier: MIT
// What a ray meets first, and which surfaces meet, against double loops and by construction.
#include "kernel/surface/search/surface_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::bumpy_sphere;
using testing::icosphere;
using testing::points_of;

/// Every triangle asked in turn: a + u (b - a) + v (c - a) = origin + distance * direction.
std::optional<RayHit> first_hit_by_loop(const Mesh& mesh, const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction) {
  std::optional<RayHit> first;
  for (int face = 0; face < mesh.triangles.rows(); ++face) {
    const Eigen::Vector3d a = mesh.vertices.row(mesh.triangles(face, 0)),
                          b = mesh.vertices.row(mesh.triangles(face, 1)),
                          c = mesh.vertices.row(mesh.triangles(face, 2));
    Eigen::Matrix3d system;
    system << b - a, c - a, -direction;
    const Eigen::Vector3d solution = system.inverse() * (origin - a);
    if (!(solution.minCoeff() >= 0 && solution(0) + solution(1) <= 1)) continue;
    const double cosine = std::abs((b - a).cross(c - a).normalized().dot(direction));
    if (!first || solution(2) < first->distance) first = RayHit{face, solution(2), cosine};
  }
  return first;
}

Mesh moved(const Mesh& mesh, const Eigen::Vector3d& by) { return move_mesh(mesh, {Eigen::Matrix3d::Identity(), by}); }

TEST(SurfaceTree, FindsWhatALoopOverAllTrianglesFinds) {
  const Mesh mesh = bumpy_sphere(3, 1);
  const SurfaceTree tree(mesh);
  RandomStream random(2);
  int hits = 0, misses = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d origin = (i % 3 == 0 ? 0.3 : 3) * random.direction(), direction = random.direction();
    const auto found = tree.first_hit(origin, direction), expected = first_hit_by_loop(mesh, origin, direction);
    ASSERT_EQ(found.has_value(), expected.has_value()) << i;
    found ? ++hits : ++misses;
    if (!found) continue;
    EXPECT_EQ(found->triangle, expected->triangle);
    EXPECT_NEAR(found->distance, expected->distance, 1e-12);
    EXPECT_NEAR(found->cosine, expected->cosine, 1e-9);
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 50);
}

TEST(SurfaceTree, NoRaySlipsThroughAnEdgeOrACorner) {
  const Mesh mesh = icosphere(2);
  const SurfaceTree tree(mesh);
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    const Eigen::Vector3d a = mesh.vertices.row(mesh.triangles(face, 0)),
                          b = mesh.vertices.row(mesh.triangles(face, 1));
    for (const Eigen::Vector3d& aim : {a, Eigen::Vector3d((a + b) / 2), Eigen::Vector3d(0.3 * a + 0.7 * b)})
      EXPECT_TRUE(tree.first_hit({0, 0, 0}, aim.normalized()));
  }
}

TEST(SurfaceTree, TrianglesWithoutAreaAreNotThere) {
  Mesh mesh{points_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, -1}, {4, 0, -1}, {0, 4, -1}}), Triangles(3, 3)};
  mesh.triangles << 0, 1, 2, 1, 1, 1, 3, 4, 5;
  const auto hit = SurfaceTree(mesh).first_hit({1, 0.01, 5}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 2) << "rows of the mesh, not of what is left";
  EXPECT_EQ(hit->distance, 6);
  EXPECT_EQ(hit->cosine, 1);
}

TEST(SurfaceTree, BothSidesOfATriangleAreMet) {
  const SurfaceTree tree(testing::grid(3, 3));
  EXPECT_EQ(tree.first_hit({0.7, 0.6, 2}, {0, 0, -1})->distance, 2);
  EXPECT_EQ(tree.first_hit({0.7, 0.6, -2}, {0, 0, 1})->distance, 2);
  EXPECT_FALSE(tree.first_hit({0.7, 0.6, 2}, {0, 0, 1})) << "behind the origin of the ray";
}

TEST(SurfaceTree, ATriangleSeenEdgeOnIsMetAtItsNearCorner) {
  const SurfaceTree tree(testing::grid(2, 2));
  const auto hit = tree.first_hit({-3, 0.5, 0}, {1, 0, 0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->distance, 3);
  EXPECT_EQ(hit->cosine, 0);
}

TEST(SurfaceTree, SurfacesMeetWhereTheyCrossOrTouch) {
  const Mesh ball = icosphere(2), flat = testing::grid(3, 3);
  const SurfaceTree tree(ball), floor(flat);
  EXPECT_TRUE(tree.meets(moved(ball, {1.9, 0, 0})));
  EXPECT_FALSE(tree.meets(moved(ball, {2.1, 0, 0})));
  EXPECT_FALSE(tree.meets(icosphere(2, 0.5))) << "wholly inside";
  EXPECT_TRUE(floor.meets(moved(flat, {2, 0, 0}))) << "an edge in common";
  EXPECT_FALSE(floor.meets(moved(flat, {0, 0, 1e-12})));
}

TEST(SurfaceTree, RefusesWhatHasNoSurface) {
  EXPECT_THROW(SurfaceTree({testing::grid(3, 3).vertices, Triangles(0, 3)}), InvalidInput);
  Mesh flat{points_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), Triangles(1, 3)};
  flat.triangles << 0, 1, 2;
  EXPECT_THROW(SurfaceTree{flat}, InvalidInput);
  flat.vertices(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SurfaceTree{flat}, InvalidInput);
}

}  // namespace
}  // namespace corral
