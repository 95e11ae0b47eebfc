// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/view_side.h"

#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace corral {
namespace {

using testing::seen_along;
using testing::seen_from;

/// In the plane z = -5, its front to +z.
Mesh floor_below() {
  Mesh mesh = testing::grid(8, 8);
  mesh.vertices.col(2).setConstant(-5);
  return mesh;
}

TEST(FrontShare, IsOfTheAreaWhoseFrontTheSensorSees) {
  const Mesh mesh = floor_below();
  EXPECT_EQ(front_share(mesh, seen_from({3, 3, 0})), 1);
  EXPECT_EQ(front_share(mesh, seen_from({3, 3, -9})), 0);
  EXPECT_EQ(front_share(mesh, seen_along({0, 0, -1})), 1);
  EXPECT_EQ(front_share(mesh, seen_along({0, 0, 1})), 0);
  EXPECT_NEAR(front_share(testing::icosphere(3), seen_along({1, 0, 0})).value(), 0.5, 0.05);
}

TEST(FrontShare, GoesByTheNormalsOfACloudAndIsAbsentWithout) {
  Mesh cloud = floor_below();
  cloud.triangles.resize(0, 3);
  EXPECT_FALSE(front_share(cloud, {}));
  cloud.normals = Points::Zero(cloud.vertices.rows(), 3);
  cloud.normals.col(2).setConstant(-2);
  EXPECT_EQ(front_share(cloud, seen_along({0, 0, 1})), 1);
}

TEST(ViewSide, TakesTheSensorOfTheMeshThenTheOriginThenTheSideOfTheFaces) {
  Mesh mesh = floor_below();
  EXPECT_FALSE(view_side(mesh).direction) << "the origin sees the front";
  EXPECT_TRUE(view_side(mesh).sensor.isZero(0));
  mesh.vertices.col(2).setConstant(5);  // the origin sees the back
  ASSERT_TRUE(view_side(mesh).direction);
  EXPECT_TRUE(view_side(mesh).direction->isApprox(Eigen::Vector3d(0, 0, -1)));
  mesh.sensor = Eigen::Vector3d(1, 2, 30);
  EXPECT_EQ(view_side(mesh).sensor, *mesh.sensor);
  EXPECT_FALSE(view_side(mesh).direction);
  mesh.sensor.reset();
  mesh.triangles.resize(0, 3);
  EXPECT_FALSE(view_side(mesh).direction) << "nothing is known";
  Mesh ball = testing::icosphere(3);
  ball.vertices.col(0).array() += 7;
  ASSERT_LT(front_share(ball, {}).value(), 0.5);
  EXPECT_FALSE(view_side(ball).direction) << "a closed surface has no side";
}

}  // namespace
}  // namespace corral
