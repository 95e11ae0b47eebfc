// SPDX-License-Identifier: MIT
#include "kernel/surface/search/neighborhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernel/random.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/surface.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::lattice;
using testing::points_of;
using testing::uniform_points;

Indices rows_of(const std::vector<Neighbor>& neighbors) {
  Indices rows;
  for (const Neighbor& neighbor : neighbors) rows.push_back(neighbor.index);
  return rows;
}

void expect_same(const std::vector<Neighbor>& found, const std::vector<Neighbor>& expected) {
  ASSERT_EQ(rows_of(found), rows_of(expected));
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i].squared_distance, expected[i].squared_distance, 1e-12 * (1 + expected[i].squared_distance));
}

/// Every query against brute force, from points of the set and from places in between.
void expect_agrees(const Points& points, const std::vector<double>& radii, std::uint64_t seed) {
  const PointIndex index(points);
  RandomStream random(seed);
  for (int trial = 0; trial < 40; ++trial) {
    Eigen::Vector3d query = random.direction();
    if (points.rows() > 0)
      query =
          points.row(static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(points.rows())))).transpose();
    if (trial % 2 == 1) query += random.uniform(0, 0.5) * random.direction();
    for (const double radius : radii)
      expect_same(index.within(query, radius), testing::reference_within(points, query, radius));
    for (const int count : {1, 2, 7, 20, 5000})
      expect_same(index.nearest(query, count), testing::reference_nearest(points, query, count));
  }
}

TEST(PointIndex, UniformPointsAgreeWithBruteForce) {
  expect_agrees(uniform_points(1500, 1), {0, 0.05, 0.2, 0.7, 9}, 2);
}

TEST(PointIndex, ClusteredPointsAgreeWithBruteForce) {
  expect_agrees(testing::clustered_points(1200, 3), {0, 1e-4, 1e-3, 0.1, 2, 20}, 4);
}

TEST(PointIndex, FlatAndStraightPointsAgreeWithBruteForce) {
  Points points = uniform_points(800, 5);
  points.col(2).setZero();
  expect_agrees(points, {0, 0.1, 0.5}, 6);
  points.col(1).setZero();
  expect_agrees(points, {0, 0.1, 0.5}, 7);
}

TEST(PointIndex, TiesGoToTheLowerIndex) {
  const Points points = lattice(9);
  const PointIndex index(points);
  // Whole and half coordinates: every squared distance is exact on both sides.
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Vector3d query(trial % 9, (trial / 3 % 17) * 0.5, 4 + trial % 2 * 0.5);
    for (int count = 1; count < 40; ++count)
      expect_same(index.nearest(query, count), testing::reference_nearest(points, query, count));
    for (const double radius : {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0})
      expect_same(index.within(query, radius), testing::reference_within(points, query, radius));
  }
}

TEST(PointIndex, NearlyEqualDistancesAreTold) {
  // Tenths are not exact: distances that would tie differ in their last bits, and those bits decide.
  for (const double offset : {0.0, 0.7, 1e7}) {
    const Points points = 0.1 * lattice(10).array() + offset;
    const PointIndex index(points);
    for (int row = 0; row < points.rows(); row += 17) {
      const Eigen::Vector3d query = points.row(row).transpose();
      for (int count = 1; count < 40; ++count)
        expect_same(index.nearest(query, count), testing::reference_nearest(points, query, count));
      for (const double radius : {0.1, 0.2, 0.3, 0.1 * std::sqrt(2.0), 0.1 * std::sqrt(3.0)})
        expect_same(index.within(query, radius), testing::reference_within(points, query, radius));
    }
  }
}

TEST(PointIndex, RadiusIsInclusive) {
  const PointIndex index(points_of({{0, 0, 0}, {3, 4, 0}, {0, 5.000001, 0}}));
  EXPECT_THAT(rows_of(index.within({0, 0, 0}, 5)), ElementsAre(0, 1));
  EXPECT_THAT(rows_of(index.within({3, 4, 0}, 0)), ElementsAre(1));
}

TEST(PointIndex, FewPoints) {
  expect_agrees(points_of({{1, 2, 3}}), {0, 1, 10}, 9);
  expect_agrees(points_of({{1, 2, 3}, {1, 2, 4}}), {0, 1, 10}, 10);
}

TEST(PointIndex, NoPoints) { expect_agrees(Points(0, 3), {0, 1, 10}, 8); }

TEST(PointIndex, TwoThousandPointsInOnePlace) {
  const Points points = Eigen::RowVector3d(0.5, -2, 7).replicate(2000, 1);
  const PointIndex index(points);
  const Eigen::Vector3d place = points.row(0).transpose();
  EXPECT_EQ(index.within(place, 0).size(), 2000u);
  EXPECT_THAT(rows_of(index.nearest(place, 3)), ElementsAre(0, 1, 2));
  expect_agrees(points, {0, 0.3, 1}, 11);
}

TEST(PointIndex, AHundredThousandPointsInOnePlaceAreAsOne) {
  // As scans have them that put what they missed at the origin.
  Points points = testing::stacked({uniform_points(300, 16), Points::Zero(100000, 3), uniform_points(300, 17)});
  const PointIndex index(points);
  EXPECT_EQ(index.within({0, 0, 0}, 0).size(), 100000u);
  EXPECT_EQ(index.within({0, 0, 0}, 9).size(), 100600u);
  EXPECT_THAT(rows_of(index.nearest({0, 0, 0}, 3)), ElementsAre(300, 301, 302));
  EXPECT_THAT(rows_of(index.nearest(points.row(5).transpose(), 1)), ElementsAre(5));
  expect_same(index.nearest({0, 0, 0}, 100050), testing::reference_nearest(points, {0, 0, 0}, 100050));
}

TEST(PointIndex, DuplicatesAmongOthersComeInOrder) {
  Points points = uniform_points(900, 12);
  for (int row = 300; row < 900; ++row) points.row(row) = points.row(row % 300);
  expect_agrees(points, {0, 0.1, 0.4}, 13);
}

TEST(PointIndex, FarFromTheOrigin) {
  for (const double offset : {1e7, -1e7}) {
    const Points points = uniform_points(700, 14).array() + offset;
    expect_agrees(points, {0, 0.1, 0.5}, 15);
    expect_same(PointIndex(points).nearest({0, 0, 0}, 3), testing::reference_nearest(points, {0, 0, 0}, 3));
  }
}

TEST(PointIndex, RadiusThatIsNoRadiusFindsNothing) {
  const PointIndex index(lattice(3));
  for (const double radius : {-1.0, -1e-300, std::nan(""), HUGE_VAL, -HUGE_VAL})
    EXPECT_THAT(index.within({1, 1, 1}, radius), IsEmpty()) << radius;
}

TEST(PointIndex, CountsThatAskForNothingOrForAll) {
  const PointIndex index(lattice(3));
  EXPECT_THAT(index.nearest({1, 1, 1}, 0), IsEmpty());
  EXPECT_EQ(index.nearest({1, 1, 1}, 27).size(), 27u);
  EXPECT_EQ(index.nearest({1, 1, 1}, std::numeric_limits<int>::max()).size(), 27u);
}

TEST(PointIndex, KeepsItsOwnCopy) {
  Points points = lattice(3);
  const PointIndex index(points);
  points.setConstant(100);
  EXPECT_THAT(rows_of(index.nearest({0, 0, 0}, 1)), ElementsAre(0));
}

}  // namespace
}  // namespace corral
