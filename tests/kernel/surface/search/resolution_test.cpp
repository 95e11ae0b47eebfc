// SPDX-License-Identifier: MIT
#include "kernel/surface/search/resolution.h"

#include <gtest/gtest.h>

#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/surface.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

TEST(PointResolution, GridHasItsSpacing) {
  EXPECT_DOUBLE_EQ(point_resolution(testing::grid(7, 5, 1.0).vertices), 1.0);
  EXPECT_DOUBLE_EQ(point_resolution(testing::grid(7, 5, 0.375).vertices), 0.375);
}

TEST(PointResolution, IcosahedronHasItsEdge) {
  // Edge over radius of a regular icosahedron: 1 / sin(72 degrees).
  EXPECT_NEAR(point_resolution(testing::icosphere(0).vertices), 1 / std::sin(std::acos(-1.0) * 72 / 180), 1e-14);
}

TEST(PointResolution, IsTheMeanOverVerticesNotOverPairs) {
  EXPECT_DOUBLE_EQ(point_resolution(points_of({{0, 0, 0}, {1, 0, 0}, {4, 0, 0}})), (1.0 + 1.0 + 3.0) / 3);
}

TEST(PointResolution, AgreesWithBruteForce) {
  for (const Points& vertices :
       {testing::bumpy_sphere(3, 4).vertices, testing::icosphere(3).vertices, testing::icosphere(4, 250.0).vertices}) {
    const double expected = testing::reference_resolution(vertices);
    EXPECT_NEAR(point_resolution(vertices), expected, 1e-13 * expected);
  }
}

TEST(PointSpacing, HasTheMedianAndTheStrays) {
  Points points = testing::grid(30, 30, 1.0).vertices;
  const PointSpacing clean = point_spacing(points);
  EXPECT_DOUBLE_EQ(clean.resolution, 1);
  EXPECT_DOUBLE_EQ(clean.median, 1);
  EXPECT_DOUBLE_EQ(clean.without_strays, 1);
  EXPECT_TRUE(clean.strays.empty());
  EXPECT_FALSE(clean.is_moved_by_strays());
  points.row(17) << 15, 15, 4500;
  points.row(40) << 15, 15, 4500;  // twice in one place: a stray still
  for (int threads = 0; threads < 2; ++threads) {
    const PointSpacing moved =
        point_spacing(points, threads == 0 ? ParallelFor(one_by_one) : testing::on_three_threads);
    EXPECT_EQ(moved.strays, (Indices{17, 40}));
    EXPECT_DOUBLE_EQ(moved.median, 1);
    EXPECT_DOUBLE_EQ(moved.without_strays, 1);
    EXPECT_DOUBLE_EQ(moved.stray_distance, Eigen::Vector3d(0, 0, 4500).norm());
    EXPECT_NEAR(moved.resolution, (898 + 4500) / 899.0, 1e-9);
    EXPECT_TRUE(moved.is_moved_by_strays());
  }
}

TEST(PointSpacing, StraysMayLieBesideEachOther) {
  Points points = testing::grid(30, 30, 1.0).vertices;
  points.row(17) << 15, 15, 4500;
  points.row(40) << 15, 19, 4500;
  points.row(41) << 15, 19, 4500;
  points.row(600) << 15, 15, 4504;
  const PointSpacing spacing = point_spacing(points);
  EXPECT_EQ(spacing.strays, (Indices{17, 40, 41, 600}));
  EXPECT_DOUBLE_EQ(spacing.without_strays, 1);
  EXPECT_DOUBLE_EQ(spacing.stray_distance, 4504);
  EXPECT_FALSE(spacing.is_moved_by_strays());  // three distances of 4 among 896
  points.row(700) << 15, 30, 4504;             // four together are a part of their own
  EXPECT_TRUE(point_spacing(points).strays.empty());
}

TEST(PointSpacing, IsThatOfAllPairs) {
  RandomStream random(8);
  int alone = 0, together = 0;
  for (int round = 0; round < 40 && !HasFailure(); ++round) {
    SCOPED_TRACE(round);
    Points points = testing::bumpy_sphere(3, static_cast<std::uint64_t>(round)).vertices;
    const auto any_row = [&] {
      return static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(points.rows())));
    };
    for (auto groups = random.below(6); groups > 0; --groups) {
      const Eigen::RowVector3d place = (1.5 + 20 * random.uniform()) * random.direction().transpose();
      for (auto size = 1 + random.below(5); size > 0; --size)
        points.row(any_row()) = place + 1.2 * random.uniform() * random.direction().transpose();
    }
    if (round % 3 == 0) points.row(any_row()) = points.row(any_row()).eval();
    const PointSpacing found = point_spacing(points), expected = testing::reference_spacing(points);
    EXPECT_EQ(found.strays, expected.strays);
    EXPECT_NEAR(found.without_strays, expected.without_strays, 1e-12 * expected.without_strays);
    EXPECT_NEAR(found.stray_distance, expected.stray_distance, 1e-12);
    EXPECT_DOUBLE_EQ(found.median, expected.median);
    alone += expected.strays.size() == 1;
    together += expected.strays.size() > 1;
  }
  EXPECT_GT(alone, 1);
  EXPECT_GT(together, 10);
}

TEST(PointSpacing, ManyFarVerticesAreNoStrays) {
  Points points = testing::grid(30, 30, 1.0).vertices;
  for (int row = 0; row < 30; ++row) points.row(30 * row).array() += 500 + 60 * row;
  const PointSpacing uneven = point_spacing(points);
  EXPECT_EQ(uneven.strays.size(), 30U);
  EXPECT_EQ(uneven.without_strays, uneven.resolution);
  EXPECT_FALSE(uneven.is_moved_by_strays());
}

TEST(PointResolution, DuplicatesCountOnce) {
  EXPECT_DOUBLE_EQ(point_resolution(points_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {0, 0, 0}})),
                   5.0 / 3);
  EXPECT_DOUBLE_EQ(point_resolution(points_of({{0.0, 0, 0}, {-0.0, 0, 0}, {2, 0, 0}})), 2.0);
}

TEST(PointResolution, ScalesAndSurvivesAnOffset) {
  const Points vertices = testing::bumpy_sphere(3, 5).vertices;
  const double resolution = point_resolution(vertices);
  EXPECT_DOUBLE_EQ(point_resolution(1024 * vertices), 1024 * resolution);
  EXPECT_NEAR(point_resolution(vertices.array() + 1e7), resolution, 1e-7);
}

TEST(PointResolution, NeedsTwoDistinctVertices) {
  EXPECT_THROW(point_resolution(Points(0, 3)), InvalidInput);
  EXPECT_THROW(point_resolution(points_of({{1, 2, 3}})), InvalidInput);
  EXPECT_THROW(point_resolution(points_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}})), InvalidInput);
}

}  // namespace
}  // namespace corral
