// SPDX-License-Identifier: MIT
#include "grouping/turboreg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing::table_of_points;

void expect_nothing(const GroupingResult& result) {
  EXPECT_THAT(result.selected, IsEmpty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

void expect_pose(const GroupingResult& result, const RigidTransform& expected) {
  ASSERT_TRUE(result.target_from_source.has_value());
  EXPECT_TRUE(result.target_from_source->rotation.isApprox(expected.rotation, 1e-9));
  EXPECT_TRUE((result.target_from_source->translation - expected.translation).isZero(1e-9));
}

TurboregOptions raw(int pivots = 1000) {
  TurboregOptions options;
  options.refit_rounds = 0;
  options.pivots = pivots;
  return options;
}

/// Four corners that stay and one row that goes astray. Each of the six edges has two common neighbours.
CorrespondenceSet corners_and_a_stray() {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                         {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
}

/// Corners that D tells apart. In the target the edges leave the first corner with 20 + a, 20 + b, 20 + c.
CorrespondenceSet stretched_corners(double a, double b, double c) {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}},
                         {{0, 0, 0}, {20 + a, 0, 0}, {0, 20 + b, 0}, {0, 0, 20 + c}});
}

TEST(Turboreg, CornersThatStay) {
  for (const int pivots : {1, 6, 1000}) {
    const GroupingResult result = group_by_turboreg(corners_and_a_stray(), raw(pivots));
    EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
    expect_pose(result, RigidTransform());
    EXPECT_THAT(result.scores, IsEmpty());
  }
}

TEST(Turboreg, StrayRowsChangeNothing) {
  CorrespondenceSet table = corners_and_a_stray();
  const GroupingResult without = group_by_turboreg(select_rows(table, {0, 1, 2, 3}));
  EXPECT_EQ(group_by_turboreg(table).selected, without.selected);
  EXPECT_EQ(group_by_turboreg(table).target_from_source->translation, without.target_from_source->translation);
}

TEST(Turboreg, WithoutTrianglesNothing) {
  const CorrespondenceSet table = corners_and_a_stray();
  expect_nothing(group_by_turboreg(select_rows(table, {0, 1})));
  expect_nothing(group_by_turboreg(select_rows(table, {0, 1, 4})));  // an edge, but no common neighbour
  expect_nothing(group_by_turboreg(stretched_corners(3, 6, 9)));     // no edge
}

TEST(Turboreg, DifferenceOfLengthsIsBelowTheLimit) {
  // The third row is off by 2 in its length to the first; 20.2^2 = 408.04 keeps D to the second below.
  const CorrespondenceSet table =
      table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}}, {{0, 0, 0}, {20, 0, 0}, {0, 22, 0}});
  TurboregOptions options = raw();
  expect_nothing(group_by_turboreg(table, options));
  options.edge_pr = 2 + 1e-9;
  EXPECT_THAT(group_by_turboreg(table, options).selected, ElementsAre(0, 1, 2));
  CorrespondenceSet in_mm = table;
  in_mm.resolution = 2;  // 2 mesh units are 1 pr
  EXPECT_THAT(group_by_turboreg(in_mm, raw()).selected, ElementsAre(0, 1, 2));
}

TEST(Turboreg, SumOfTheLengthsIsAboveTheLimit) {
  const CorrespondenceSet table = table_of_points({{0, 0, 0}, {5, 0, 0}, {0, 8, 0}}, {{0, 0, 0}, {5, 0, 0}, {0, 8, 0}});
  TurboregOptions options = raw();
  expect_nothing(group_by_turboreg(table, options));  // 5 + 5 = 10
  options.min_length_pr = 10 - 1e-9;
  EXPECT_THAT(group_by_turboreg(table, options).selected, ElementsAre(0, 1, 2));
}

TEST(Turboreg, FlatTrianglesGiveNoPose) {
  const std::vector<testing::Row3> line = {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}, {70, 0, 0}};
  expect_nothing(group_by_turboreg(table_of_points(line, line)));
}

TEST(Turboreg, PivotsAreTheEdgesWithTheMostCommonNeighbors) {
  // Four rows that stay and five that move by 500: three common neighbours on an edge against two. A flat triangle of
  // the five gives no pose, so their places are in general position.
  const std::vector<testing::Row3> source = {{0, 0, 0},   {20, 0, 0},  {0, 20, 0},  {0, 0, 20},  {60, 0, 0},
                                             {60, 30, 0}, {60, 5, 40}, {95, 10, 7}, {70, 60, 20}};
  std::vector<testing::Row3> target = source;
  for (std::size_t row = 4; row < 9; ++row) target[row][0] += 500;
  const GroupingResult found = group_by_turboreg(table_of_points(source, target), raw(1));
  EXPECT_THAT(found.selected, ElementsAre(4, 5, 6, 7, 8));
  EXPECT_DOUBLE_EQ(found.target_from_source->translation.x(), 500);
}

TEST(Turboreg, EqualEdgesByTheSmallerDifference) {
  // All edges have two common neighbours. D of the edges from the first corner: 0.1, 0.2, 0.8; of the others by
  // sqrt((20+a)^2 + (20+b)^2) - sqrt(800): 0.212, 0.638, 0.709. The pivot is 0-1; its thirds have max(0.2, 0.212) and
  // max(0.8, 0.638). Both triangles are tried; mae decides.
  const CorrespondenceSet table = stretched_corners(0.1, 0.2, 0.8);
  const GroupingResult found = group_by_turboreg(table, raw(1));
  EXPECT_THAT(found.selected, ElementsAre(0, 1, 2, 3));
  const auto mae = [&](const RigidTransform& pose) {
    std::vector<double> residuals;
    measure_residuals(table, pose, residuals);
    return PoseScorer(table, PoseScore::Mae, 5)(residuals);
  };
  const RigidTransform one = *fit_rigid_transform(table, {0, 1, 2}), other = *fit_rigid_transform(table, {0, 1, 3});
  EXPECT_NE(mae(one), mae(other));
  expect_pose(found, mae(one) > mae(other) ? one : other);
}

TEST(Turboreg, ThirdsAreTheTwoWithTheLargestSums) {
  // Six rows that stay but for small stretches: all have four common neighbours on every edge. The seventh agrees with
  // the first three only, and is the best third by its distances: its sum is smaller, so it makes no triangle.
  std::vector<testing::Row3> source = {{0, 0, 0},   {20, 0, 0},  {0, 20, 0}, {0, 0, 20},
                                       {20, 20, 9}, {7, 20, 20}, {-20, 0, 0}};
  std::vector<testing::Row3> target = source;
  for (std::size_t row = 3; row < 6; ++row) target[row][2] += 0.1 * static_cast<double>(row);
  target[6] = {20 - 40.0 * 0.1, 0, 0};  // at the same distance from the first as before, in another direction
  const CorrespondenceSet table = table_of_points(source, target);
  const GroupingResult found = group_by_turboreg(table, raw(1));
  EXPECT_THAT(found.selected, ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Turboreg, MorePivotsNeverScoreLess) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CorrespondenceSet table = testing::synthetic(80, 0.15, seed).matches;
    std::size_t before = 0;
    for (const int pivots : {1, 3, 10, 30, 100, 300, 1000, 10000}) {
      const std::size_t found = group_by_turboreg(table, raw(pivots)).selected.size();
      EXPECT_GE(found, before) << pivots;
      before = found;
    }
    EXPECT_GE(before, 6U);
    const GroupingResult all = group_by_turboreg(table, raw(80 * 79 / 2)), more = group_by_turboreg(table, raw(100000));
    EXPECT_EQ(all.target_from_source->rotation, more.target_from_source->rotation);
  }
}

TEST(Turboreg, RefitImprovesThePose) {
  double raw_error = 0, error = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticProblem problem = testing::synthetic(150, 0.3, seed);
    const auto off = [&](const TurboregOptions& options) {
      const auto pose = group_by_turboreg(problem.matches, options).target_from_source;
      return point_error(*pose, problem.truth, problem.matches.source_points, 1)->rmse_pr;
    };
    raw_error += off(raw());
    error += off({});
  }
  EXPECT_LT(error, raw_error / 1.5);
}

TEST(Turboreg, RunnerUpIsTheOtherMotion) {
  const SyntheticProblem problem = testing::synthetic(60, 1, 3);
  CorrespondenceSet table = problem.matches;
  for (int row = 0; row < 20; ++row) table.target_points(row, 0) += 300;
  TurboregOptions options;
  options.keep = 1;
  options.pivots = 2000;
  const GroupingResult found = group_by_turboreg(table, options);
  EXPECT_THAT(found.selected, SizeIs(40));
  ASSERT_THAT(found.runner_up, SizeIs(1));
  RigidTransform moved = problem.truth;
  moved.translation.x() += 300;
  EXPECT_LT(point_error(found.runner_up[0].target_from_source, moved, table.source_points, 1)->rmse_pr, 5);
  options.keep = 0;
  EXPECT_EQ(group_by_turboreg(table, options).target_from_source->translation, found.target_from_source->translation);
  EXPECT_THAT(group_by_turboreg(table, options).runner_up, IsEmpty());
}

}  // namespace
}  // namespace corral
