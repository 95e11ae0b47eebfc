// SPDX-License-Identifier: MIT
#include "kernel/surface/shot.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/shot.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;
using testing::support_of;

Eigen::Vector3d vertex_of(const Mesh& mesh, int row) { return mesh.vertices.row(row).transpose(); }

std::optional<LocalReferenceFrame> frame_at(const Points& vertices, const Eigen::Vector3d& point, double radius) {
  return shot_frame(support_of(vertices, Points::Zero(vertices.rows(), 3), point, radius), radius);
}

TEST(ShotFrame, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    for (const double radius_pr : {4.0, 15.0}) {
      const double radius = radius_pr * point_resolution(mesh.vertices);
      for (int row = 0; row < mesh.vertices.rows(); row += 13) {
        const auto found = frame_at(mesh.vertices, vertex_of(mesh, row), radius);
        ASSERT_TRUE(found.has_value());
        EXPECT_TRUE(is_valid_frame(*found));
        const auto expected = testing::reference_shot_frame(mesh.vertices, vertex_of(mesh, row), radius);
        EXPECT_LT((*found - *expected).norm(), 1e-9) << row << " " << radius_pr;
      }
    }
  }
}

TEST(ShotFrame, OrderOfTheVerticesHardlyMatters) {
  const Mesh mesh = testing::bumpy_sphere(3, 3);
  const double radius = 6 * point_resolution(mesh.vertices);
  const Points& vertices = mesh.vertices;
  const Points reversed = vertices.colwise().reverse();
  const auto forward = frame_at(vertices, vertex_of(mesh, 5), radius),
             back = frame_at(reversed, vertex_of(mesh, 5), radius);
  EXPECT_LT((*forward - *back).norm(), 1e-12);
}

TEST(ShotFrame, NeedsFiveNeighboursElsewhere) {
  Points vertices = points_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}, {-0.5, 0.2, 0}, {0.1, -0.3, 0.1}});
  EXPECT_FALSE(frame_at(vertices, {0, 0, 0}, 2).has_value());
  vertices.row(1) << 0.2, 0.2, 0.05;
  EXPECT_TRUE(frame_at(vertices, {0, 0, 0}, 2).has_value());
  EXPECT_FALSE(frame_at(vertices, {0, 0, 0}, 0.5).has_value());
  EXPECT_FALSE(frame_at(Points::Zero(40, 3), {0, 0, 0}, 2).has_value());
}

TEST(ShotFrame, TurnsToTheSideWhereMostNeighboursLie) {
  // A flat patch that reaches farther to +x than to -x, bent upward: x = +x, z = +z.
  std::vector<testing::Row3> rows;
  for (int i = -4; i <= 8; ++i)
    for (int j = -1; j <= 1; ++j)
      if (i != 0 || j != 0) rows.push_back({0.5 * i, 0.25 * j, 0.01 * i * i});
  const auto frame = frame_at(points_of(rows), {0, 0, 0}, 10);
  ASSERT_TRUE(frame.has_value());
  EXPECT_GT((*frame)(0, 0), 0.99);
  EXPECT_GT((*frame)(1, 1), 0.99);
  EXPECT_GT((*frame)(2, 2), 0.99);
}

TEST(ShotFrame, EqualSidesAreDecidedAroundTheMedianDistance) {
  // Six neighbours along x, three on each side; by distance the middle five are - - + + +, then with signs turned.
  for (const double side : {1.0, -1.0}) {
    Points vertices = points_of({{-1, 0, 0}, {-2, 0.3, 0}, {-3, -0.2, 0}, {4, 0.1, 0}, {5, 0.1, 0.1}, {6, -0.3, 0.1}});
    vertices.col(0) *= side;
    const auto frame = frame_at(vertices, {0, 0, 0}, 10);
    ASSERT_TRUE(frame.has_value());
    EXPECT_GT(side * (*frame)(0, 0), 0.99);
  }
}

TEST(ShotFrame, MovesAlongWithTheSurface) {
  const Mesh mesh = testing::bumpy_sphere(4, 4);
  const double radius = 15 * point_resolution(mesh.vertices);
  const RigidTransform motion = random_motion(mesh, 5);
  const Mesh moved = move_mesh(mesh, motion);
  for (int row = 0; row < mesh.vertices.rows(); row += 29) {
    const LocalReferenceFrame expected =
        *frame_at(mesh.vertices, vertex_of(mesh, row), radius) * motion.rotation.transpose();
    EXPECT_LT((*frame_at(moved.vertices, vertex_of(moved, row), radius) - expected).norm(), 1e-9);
  }
}

TEST(ShotFrame, IsFiniteOnFlatAndStraightNeighbourhoods) {
  const Mesh flat = testing::grid(9, 9);
  const auto frame = frame_at(flat.vertices, {4, 4, 0}, 3);
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(is_valid_frame(*frame));
  EXPECT_NEAR(std::abs((*frame)(2, 2)), 1, 1e-12);
  Points line = Points::Zero(20, 3);
  line.col(0).setLinSpaced(0.0, 1.9);
  const auto straight = frame_at(line, {0, 0, 0}, 1.5);
  EXPECT_TRUE(!straight || is_valid_frame(*straight));
}

}  // namespace
}  // namespace corral
