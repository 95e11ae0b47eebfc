// SPDX-License-Identifier: MIT
#include "kernel/surface/search/nearest_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "kernel/random.h"
#include "kernel/rigid_transform.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/surface.h"

namespace corral {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The points themselves, places between them, places off them by a unit, and some far away.
Points places_around(const Points& points, double unit, std::uint64_t seed) {
  RandomStream random(seed);
  Points queries(4 * points.rows(), 3);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3d here = points.row(row), next = points.row((row + 1) % points.rows());
    queries.row(4 * row) = here;
    queries.row(4 * row + 1) = (here + next) / 2;
    queries.row(4 * row + 2) = here + unit * random.uniform(0, 3) * random.direction().transpose();
    queries.row(4 * row + 3) = here + 1e3 * unit * random.direction().transpose();
  }
  return queries;
}

TEST(NearestPoints, AgreeWithBruteForceOnHardSets) {
  for (const auto& set : testing::hard_point_sets()) {
    SCOPED_TRACE(set.name);
    const PointTree tree(set.points);
    if (set.points.rows() == 0) continue;
    const Points queries = places_around(set.points, set.unit, 1);
    for (const double limit : {0.0, 0.4 * set.unit, 1.0 * set.unit, 30 * set.unit, kInfinity})
      EXPECT_EQ(NearestTracker(tree).nearest(queries, limit),
                testing::reference_nearest_rows(set.points, queries, limit))
          << limit;
  }
}

TEST(NearestPoints, AgreeWithBruteForceOnManyPoints) {
  const Points points = testing::uniform_points(5000, 2), queries = testing::uniform_points(3000, 3);
  const PointTree tree(points);
  for (const double limit : {0.02, 0.1, kInfinity})
    EXPECT_EQ(NearestTracker(tree).nearest(queries, limit), testing::reference_nearest_rows(points, queries, limit))
        << limit;
}

/// Middles of lattice cells: eight points tie exactly, others after a step to a face or an edge.
TEST(NearestPoints, TiesGoToTheLowestRow) {
  const Points points = testing::lattice(7);
  const PointTree tree(points);
  NearestTracker tracker(tree);
  for (const Eigen::RowVector3d& step :
       {Eigen::RowVector3d(0.5, 0.5, 0.5), Eigen::RowVector3d(0.5, 0.5, 0), Eigen::RowVector3d(0, 0.5, 0),
        Eigen::RowVector3d(0.5, 0.25, 0.5), Eigen::RowVector3d(0.5, 0.5, 0.5)}) {
    const Points queries = points.rowwise() + step;
    for (const double limit : {std::sqrt(0.75), 5.0})
      EXPECT_EQ(tracker.nearest(queries, limit), testing::reference_nearest_rows(points, queries, limit));
  }
  Points twins(3, 3);
  twins << 1, 1, 1, 0, 0, 0, 0, 0, 0;
  const PointTree tree_of_twins(twins);
  EXPECT_THAT(NearestTracker(tree_of_twins).nearest(Points::Zero(1, 3), 9), ElementsAre(1));
}

/// Steps from hardly any to long ones, limits that narrow and widen: what is remembered never shows.
TEST(NearestPoints, QueriesAreFollowedExactly) {
  RandomStream random(4);
  const Points points = testing::bumpy_sphere(3, 5).vertices;
  const PointTree tree(points);
  NearestTracker tracker(tree);
  Points queries = testing::bumpy_sphere(3, 5).vertices * 1.1;
  int step = 0;
  for (const double length : {0.1, 0.03, 0.01, 1e-3, 1e-3, 1e-3, 0.3, 1e-6, 0.0, 0.02, 0.02, 5.0, 0.01})
    for (const double limit : {0.2, 0.05, 1.0}) {
      RigidTransform motion;
      motion.rotation = Eigen::AngleAxisd(length, random.direction()).toRotationMatrix();
      motion.translation = length * random.direction();
      queries = motion.apply(queries);
      ASSERT_EQ(tracker.nearest(queries, limit), testing::reference_nearest_rows(points, queries, limit)) << step;
      ++step;
    }
  const Points fewer = queries.topRows(100);
  EXPECT_EQ(tracker.nearest(fewer, 0.2), testing::reference_nearest_rows(points, fewer, 0.2));
}

/// Every point twice, in different rows, and queries on the points, between them and around.
TEST(NearestPoints, OfTwinsTheLowerRowIsFound) {
  const Points once = testing::bumpy_sphere(3, 6).vertices, points = testing::stacked({once.colwise().reverse(), once});
  const PointTree tree(points);
  NearestTracker tracker(tree);
  for (const double scale : {1.0, 1.02, 1.1}) {
    const Points queries = scale * points;
    EXPECT_EQ(tracker.nearest(queries, 0.2), testing::reference_nearest_rows(points, queries, 0.2)) << scale;
  }
}

TEST(NearestPoints, PairsHoldThePlacesOfBothSides) {
  const Points points = testing::uniform_points(3000, 10), queries = testing::uniform_points(1003, 11);
  const PointTree tree(points);
  const Indices expected = testing::reference_nearest_rows(points, queries, 0.08);
  NearestTracker tracker(tree);
  for (int time = 0; time < 2; ++time) {
    const PointPairs& pairs = tracker.pair(queries, 0.08);
    ASSERT_EQ(pairs.target_rows.size(), 1008u) << "whole registers";
    for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(pairs.target[axis].size(), pairs.source[axis].size());
    int found = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(pairs.target_rows[i], expected[i]);
      if (expected[i] < 0) continue;
      ++found;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(pairs.source[axis][i], queries(static_cast<Eigen::Index>(i), axis));
        EXPECT_EQ(pairs.target[axis][i], points(expected[i], axis));
      }
    }
    EXPECT_GT(found, 100);
    EXPECT_LT(found, 900);
    EXPECT_THAT(Indices(pairs.target_rows.begin() + 1003, pairs.target_rows.end()), Each(-1));
  }
}

TEST(NearestPoints, ThreadsDoNotShow) {
  const Points points = testing::uniform_points(9000, 12), queries = testing::uniform_points(9000, 13);
  const PointTree tree(points);
  const Indices expected = NearestTracker(tree).nearest(queries, 0.1);
  for (const ParallelFor& parallel : {ParallelFor(testing::last_first), ParallelFor(testing::on_three_threads)}) {
    const PointTree same(points, parallel);
    EXPECT_EQ(NearestTracker(same, parallel).nearest(queries, 0.1), expected);
  }
}

TEST(NearestPoints, WhatIsNotFiniteIsNeverFound) {
  Points points = testing::uniform_points(100, 6);
  const PointTree whole(points);
  points.row(17) << 0, kNaN, 0;
  points.row(50) << kInfinity, 0, 0;
  const PointTree tree(points);
  Points queries = testing::uniform_points(50, 7);
  queries.row(3).setConstant(kNaN);
  queries.row(4).setConstant(kInfinity);
  NearestTracker tracker(tree);
  const Indices first = tracker.nearest(queries, 10), expected = testing::reference_nearest_rows(points, queries, 10);
  EXPECT_EQ(first, expected);
  EXPECT_EQ(first[3], -1);
  EXPECT_EQ(first[4], -1);
  EXPECT_EQ(tracker.nearest(queries, 10), expected) << "twice";
  queries.row(3).setZero();
  EXPECT_EQ(tracker.nearest(queries, 10), testing::reference_nearest_rows(points, queries, 10)) << "and after that";
  EXPECT_THAT(tracker.nearest(queries, kNaN), Each(-1));
}

TEST(NearestPoints, NothingHasNoNearest) {
  const PointTree nothing{Points(0, 3)};
  EXPECT_THAT(NearestTracker(nothing).nearest(Points::Zero(2, 3), 9), ElementsAre(-1, -1));
  const PointTree one{Points::Zero(1, 3)};
  EXPECT_TRUE(NearestTracker(one).nearest(Points(0, 3), 9).empty());
  EXPECT_THAT(NearestTracker(one).nearest(Points::Ones(1, 3), 2), ElementsAre(0));
  EXPECT_THAT(NearestTracker(one).nearest(Points::Ones(1, 3), 1), ElementsAre(-1));
  const PointTree none_finite{Points::Constant(20, 3, kNaN)};
  EXPECT_THAT(NearestTracker(none_finite).nearest(Points::Zero(1, 3), 9), ElementsAre(-1));
}

TEST(NearestPoints, EveryTargetFindsTheSame) {
  const Points points = testing::clustered_points(2000, 8), queries = places_around(points, 0.01, 9);
  const PointTree tree(points);
  const Indices expected = testing::reference_nearest_rows(points, queries, 0.02);
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    EXPECT_EQ(NearestTracker(tree).nearest(queries, 0.02), expected);
  }
}

}  // namespace
}  // namespace corral
