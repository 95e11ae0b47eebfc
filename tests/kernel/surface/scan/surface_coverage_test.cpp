// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/surface_coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/surface/normals.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

RigidTransform shift(double x, double y, double z) {
  RigidTransform motion;
  motion.translation = {x, y, z};
  return motion;
}

TEST(SurfaceCoverage, IsOneForASurfaceOnItself) {
  const Mesh ball = testing::icosphere(3);
  const Points normals = estimate_normals(ball);
  const SurfaceCoverage coverage({ball.vertices, normals}, {ball.vertices, normals});
  EXPECT_NEAR(coverage(RigidTransform(), 0.1), 1, 1e-12);
  EXPECT_EQ(coverage(shift(5, 0, 0), 0.1), 0);
  EXPECT_LT(coverage(shift(0.05, 0, 0), 0.1), 0.9);
}

/// Two points a side: one 1 away with a normal that is turned by 60 degrees, one out of reach.
TEST(SurfaceCoverage, IsTheMeanOfBothSides) {
  const Points source = testing::points_of({{0, 0, 0}, {50, 0, 0}}), up = testing::points_of({{0, 0, 1}, {0, 0, 1}});
  const Points target = testing::points_of({{0, 0, 1}, {0, 90, 0}, {0, 0, 200}}),
               turned = testing::points_of({{0, std::sqrt(0.75), -0.5}, {0, 0, 1}, {0, 0, 1}});
  const double one = (1 - 1.0 / 4) * 0.5;
  const SurfaceCoverage coverage({source, up}, {target, turned});
  EXPECT_NEAR(coverage(RigidTransform(), 4), (one / 2 + one / 3) / 2, 1e-12);
  const SurfaceCoverage swapped({target, turned}, {source, up});
  EXPECT_NEAR(swapped(RigidTransform(), 4), (one / 2 + one / 3) / 2, 1e-12);
  EXPECT_NEAR(coverage(shift(0, 0, 1), 4), (0.5 / 2 + 0.5 / 3) / 2, 1e-12);
}

TEST(SurfaceCoverage, PointsWithoutANormalCountForNothing) {
  const Points points = testing::points_of({{0, 0, 0}, {9, 0, 0}}),
               normals = testing::points_of({{0, 0, 1}, {0, 0, 0}});
  EXPECT_NEAR(SurfaceCoverage({points, normals}, {points, normals})(RigidTransform(), 1), 0.5, 1e-12);
}

TEST(SurfaceCoverage, LargeSurfacesAreAskedInPart) {
  const Points points = Points::Random(50000, 3);
  Points normals = Points::Zero(50000, 3);
  normals.col(2).setOnes();
  const SurfaceCoverage coverage({points, normals}, {points, normals});
  EXPECT_NEAR(coverage(RigidTransform(), 0.1), 1, 1e-12);
}

}  // namespace
}  // namespace corral
