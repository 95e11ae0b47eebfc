// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/random.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

TEST(OverlapPoints, KeepsTheSourcePointsWithATargetNearTheirImage) {
  const PointIndex target(points_of({{10, 0, 0}, {20, 0, 0}}));
  const RigidTransform shift{Eigen::Matrix3d::Identity(), {10, 0, 0}};
  const Points source = points_of({{0, 0, 0}, {0, 2, 0}, {0, 2.001, 0}, {10, 0, -1}, {30, 0, 0}});
  // Where they are in the source, in their order; the threshold is inclusive.
  const Points shared = overlap_points(source, target, shift, 2);
  ASSERT_EQ(shared.rows(), 3);
  EXPECT_EQ(shared, points_of({{0, 0, 0}, {0, 2, 0}, {10, 0, -1}}));
}

TEST(OverlapPoints, NothingInCommonGivesNoRows) {
  const Points source = testing::grid(4, 4).vertices;
  const RigidTransform far{Eigen::Matrix3d::Identity(), {0, 0, 50}};
  EXPECT_EQ(overlap_points(source, PointIndex(source), far, 1).rows(), 0);
  EXPECT_EQ(overlap_points(Points(0, 3), PointIndex(source), {}, 1).rows(), 0);
}

TEST(OverlapPoints, TargetWithoutPointsGivesNoRows) {
  EXPECT_EQ(overlap_points(testing::grid(4, 4).vertices, PointIndex(Points(0, 3)), {}, 1).rows(), 0);
}

TEST(OverlapPoints, AMovedCopyOverlapsWholly) {
  const Points source = testing::bumpy_sphere(3, 1).vertices;
  RandomStream random(2);
  const RigidTransform motion{random.rotation(), {5, -6, 7}};
  EXPECT_EQ(overlap_points(source, PointIndex(motion.apply(source)), motion, 1e-9), source);
  EXPECT_EQ(overlap_points(source, PointIndex(motion.apply(source)), motion.inverse(), 1e-9).rows(), 0);
}

TEST(OverlapShare, IsTheSmallerCountOverTheSmallerSurface) {
  const RigidTransform shift{Eigen::Matrix3d::Identity(), {10, 0, 0}};
  const Points target = points_of({{10, 0, 0}, {11, 0, 0}, {50, 0, 0}});
  // Four source points lie near the first two of the target, which are two of its three.
  const Points source = points_of({{0, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 90, 0}});
  EXPECT_DOUBLE_EQ(overlap_share(source, target, shift, 1), 2.0 / 3);
  EXPECT_DOUBLE_EQ(overlap_share(target, source, shift.inverse(), 1), 2.0 / 3);
  EXPECT_EQ(overlap_share(source, target, shift.inverse(), 1), 0);
  EXPECT_EQ(overlap_share(source, Points(0, 3), shift, 1), 0);
  EXPECT_EQ(overlap_share(source, source, {}, 0), 1);
}

TEST(SurfaceArea, OfAGridAndABall) {
  EXPECT_NEAR(surface_area(testing::grid(4, 3, 2)), 24, 1e-12);
  EXPECT_NEAR(surface_area(testing::icosphere(5, 2)), 16 * std::acos(-1.0), 0.05);
  EXPECT_EQ(surface_area({points_of({{0, 0, 0}}), Triangles(0, 3)}), 0);
}

TEST(SharedArea, CountsTrianglesWhoseThreeCornersAreNear) {
  const Mesh surface = testing::grid(5, 3);  // 4 x 2 squares
  EXPECT_DOUBLE_EQ(surface_area(surface), 8);
  const RigidTransform up{Eigen::Matrix3d::Identity(), {0, 0, 7}};
  Points other = surface.vertices.rowwise() + Eigen::RowVector3d(0, 0, 7.5);
  EXPECT_DOUBLE_EQ(shared_area(surface, other, up, 0.5).value(), 1) << "inclusive";
  EXPECT_DOUBLE_EQ(shared_area(surface, other, up, 0.4).value(), 0);
  EXPECT_DOUBLE_EQ(shared_area(surface, other, up.inverse(), 0.5).value(), 0);
  // Without the points above x = 3 and x = 4, the last two columns of squares lack corners.
  Indices left;
  for (int row = 0; row < other.rows(); ++row)
    if (other(row, 0) < 2.5) left.push_back(row);
  EXPECT_DOUBLE_EQ(shared_area(surface, other(left, Eigen::all), up, 0.5).value(), 0.5);
  EXPECT_FALSE(shared_area({surface.vertices, Triangles(0, 3)}, other, up, 0.5)) << "a cloud has no area";
}

}  // namespace
}  // namespace corral
