// SPDX-License-Identifier: MIT
#include "kernel/surface/search/diameter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/bounding_box.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/mesh.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

/// Every pair.
double diameter_by_definition(const Points& points) {
  double largest = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const Eigen::RowVector3d d = points.row(i) - points.row(j);
      largest = std::max(largest, (d(0) * d(0) + d(1) * d(1)) + d(2) * d(2));
    }
  return std::sqrt(largest);
}

TEST(Diameter, OfFewPoints) {
  EXPECT_EQ(diameter(Points(0, 3)), 0);
  EXPECT_EQ(diameter(points_of({{1, 2, 3}})), 0);
  EXPECT_EQ(diameter(points_of({{1, 2, 3}, {1, 2, 3}})), 0);
  EXPECT_EQ(diameter(points_of({{1, 2, 3}, {4, 2, -1}})), 5);
  EXPECT_EQ(diameter(points_of({{0, 0, 0}, {1, 0, 0}, {0, 7, 0}, {0, 1, 0}})), std::sqrt(50.0));
}

TEST(Diameter, OfAGridIsItsDiagonal) {
  const Points points = testing::grid(30, 40).vertices;
  EXPECT_EQ(diameter(points), bounding_box(points).diagonal());
}

// Balls, clouds, lines and lattices (many equal distances), to the last bit.
TEST(Diameter, IsThatOfAllPairs) {
  RandomStream random(11);
  for (int trial = 0; trial < 60; ++trial) {
    Points points(1 + static_cast<int>(400 * random.uniform()), 3);
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      Eigen::RowVector3d point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (trial % 4 == 1) point.normalize();
      if (trial % 4 == 2) point = std::round(9 * point(0)) * Eigen::RowVector3d(0.1, 0.2, 0.3);
      if (trial % 4 == 3) point = (3 * point).array().round();
      points.row(row) = point;
    }
    EXPECT_EQ(diameter(points), diameter_by_definition(points)) << "trial " << trial;
  }
}

// A body of constant width: nothing tells its ends apart but the comparison itself.
TEST(Diameter, OfABodyOfConstantWidth) {
  Points points(900, 3);
  const double corners[3][2] = {{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}};
  for (int row = 0; row < 900; ++row) {
    const int corner = row / 300;
    const double angle = (corner * 120 + row % 300 * 0.2) * 3.14159265358979323846 / 180;
    points.row(row) << corners[corner][0] + std::cos(angle), corners[corner][1] + std::sin(angle), 0;
  }
  EXPECT_EQ(diameter(points), diameter_by_definition(points));
  EXPECT_NEAR(diameter(points), 1, 1e-12);
}

TEST(Diameter, DoesNotDependOnTheOrder) {
  const Points points = testing::bumpy_sphere(4, 3).vertices;
  EXPECT_EQ(diameter(points.colwise().reverse()), diameter(points));
  EXPECT_EQ(diameter(points), diameter_by_definition(points));
}

}  // namespace
}  // namespace corral
