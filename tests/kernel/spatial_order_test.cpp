// SPDX-License-Identifier: MIT
#include "kernel/spatial_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/random.h"
#include "tests/support/execution.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/spatial_order.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_permutation_of_rows(Indices order, Eigen::Index count) {
  std::sort(order.begin(), order.end());
  Indices rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return order == rows;
}

/// Mean diagonal of the boxes of groups of consecutive points.
double mean_diagonal(const Points& points, const Indices& order, std::size_t share) {
  double sum = 0;
  int boxes = 0;
  for (std::size_t first = 0; first + share <= order.size(); first += share, ++boxes) {
    const Points part = points(Indices(order.begin() + static_cast<std::ptrdiff_t>(first),
                                       order.begin() + static_cast<std::ptrdiff_t>(first + share)),
                               Eigen::all);
    sum += (part.colwise().maxCoeff() - part.colwise().minCoeff()).norm();
  }
  return sum / boxes;
}

TEST(SpatialOrder, EveryRowComesOnce) {
  for (const auto& set : testing::hard_point_sets()) {
    SCOPED_TRACE(set.name);
    EXPECT_TRUE(is_permutation_of_rows(spatial_order(set.points), set.points.rows()));
  }
  EXPECT_TRUE(spatial_order(Points(0, 3)).empty());
}

TEST(SpatialOrder, EveryPartIsCutAcrossItsLongestSide) {
  for (const int count : {1, 7, 8, 9, 16, 63, 64, 65, 100, 513, 4096, 5000, 40000}) {
    const Points points = testing::uniform_points(count, static_cast<std::uint64_t>(count));
    EXPECT_TRUE(testing::is_spatial_order(points, spatial_order(points))) << count;
    const Points with_ties = (7 * points.array()).round();
    EXPECT_TRUE(testing::is_spatial_order(with_ties, spatial_order(with_ties))) << count;
  }
}

/// A square of 64 x 64 cells, shuffled: eight of its points cannot lie in less than a box of 2 x 4, nor 64 in less than 8 x 8.
TEST(SpatialOrder, NeighboursStayTogether) {
  RandomStream random(1);
  Points points(4096, 3);
  Indices shuffled(4096);
  std::iota(shuffled.begin(), shuffled.end(), 0);
  for (std::size_t i = shuffled.size(); i > 1; --i)
    std::swap(shuffled[i - 1], shuffled[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
  for (int i = 0; i < 4096; ++i) points.row(shuffled[static_cast<std::size_t>(i)]) << i % 64, i / 64, 0;
  const Indices order = spatial_order(points);
  EXPECT_NEAR(mean_diagonal(points, order, 8), std::hypot(1, 3), 1e-9);
  EXPECT_NEAR(mean_diagonal(points, order, 64), std::hypot(7, 7), 1e-9);
}

/// Sorted, reversed, all equal, saw teeth: no order of the input is slow enough to be felt.
TEST(SpatialOrder, NoOrderOfTheInputIsHard) {
  constexpr int kCount = 200000;
  Points points = Points::Zero(kCount, 3);
  for (const int kind : {0, 1, 2, 3, 4}) {
    for (int i = 0; i < kCount; ++i)
      points(i, 0) = kind == 0 ? i : kind == 1 ? -i : kind == 2 ? 1 : kind == 3 ? i % 9 : i % 2 == 0 ? i : kCount - i;
    EXPECT_TRUE(is_permutation_of_rows(spatial_order(points), kCount)) << kind;
  }
}

TEST(SpatialOrder, WhatIsNotFiniteComesLast) {
  Points points = testing::uniform_points(6, 1);
  points.row(1) << 0, kNaN, 0;
  points.row(4) << kInfinity, 0, 0;
  const Indices order = spatial_order(points);
  EXPECT_TRUE(is_permutation_of_rows(order, 6));
  EXPECT_THAT(Indices(order.begin() + 4, order.end()), ElementsAre(1, 4));
}

TEST(SpatialOrder, ThreadsAndTargetsDoNotShow) {
  const Points points = testing::clustered_points(5000, 2);
  const Indices expected = spatial_order(points);
  EXPECT_EQ(spatial_order(points, testing::last_first), expected);
  EXPECT_EQ(spatial_order(points, testing::on_three_threads), expected);
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    for (const auto& set : testing::hard_point_sets()) {
      const Indices order = spatial_order(set.points);
      const testing::ForcedTarget baseline(testing::available_targets().back());
      EXPECT_EQ(spatial_order(set.points), order) << set.name;
    }
  }
}

/// Extents from nothing to what only halves can be subtracted of, and far from the origin.
TEST(SpatialOrder, ScaleAndPlaceDoNotShow) {
  const Points points = testing::uniform_points(1000, 3);
  const Indices expected = spatial_order(points);
  for (const double scale : {0x1p-900, 0x1p40, 0x1p1020}) EXPECT_EQ(spatial_order(scale * points), expected) << scale;
  EXPECT_TRUE(is_permutation_of_rows(spatial_order(5e-324 * points), 1000));
  EXPECT_TRUE(is_permutation_of_rows(spatial_order((1e300 * points).array() + 1e307), 1000));
}

}  // namespace
}  // namespace corral
