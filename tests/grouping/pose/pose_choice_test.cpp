// SPDX-License-Identifier: MIT
#include "grouping/pose/pose_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

RigidTransform shift(double x, double y = 0, double z = 0) {
  RigidTransform motion;
  motion.translation = {x, y, z};
  return motion;
}

/// Four corners that stay and one row that goes astray.
CorrespondenceSet corners() {
  return testing::table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                                  {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
}

GroupingResult choose(const CorrespondenceSet& table, const std::vector<RigidTransform>& poses,
                      const PoseRule& rule = {}) {
  PoseChoice choice(table, rule);
  for (const RigidTransform& pose : poses) choice.offer(pose);
  return choice.finish();
}

TEST(PoseChoice, MoreRowsThenSmallerResidualsThenTheFirst) {
  const CorrespondenceSet table = corners();
  EXPECT_THAT(choose(table, {shift(80, 80, 100), shift(3)}).selected, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(choose(table, {shift(3), shift(1), shift(2)}).target_from_source->translation.x(), 1);
  EXPECT_EQ(choose(table, {shift(3), shift(0, 2), shift(2)}).target_from_source->translation.y(), 2);
}

TEST(PoseChoice, FewerThanThreeRowsAreNothing) {
  const GroupingResult result = choose(corners(), {shift(80, 80, 100)});
  EXPECT_THAT(result.selected, IsEmpty());
  EXPECT_FALSE(result.target_from_source);
  EXPECT_THAT(choose(corners(), {}).selected, IsEmpty());
}

TEST(PoseChoice, DroppingHopelessPosesChangesNothing) {
  for (const PoseScore score : {PoseScore::Inliers, PoseScore::Mae, PoseScore::Mse, PoseScore::Msac, PoseScore::Oamae})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const SyntheticProblem problem = testing::synthetic(200, 0.3, seed);
      RandomStream random(seed);
      std::vector<RigidTransform> poses;
      for (int i = 0; i < 60; ++i) {
        RigidTransform pose = problem.truth;
        pose.translation += 6 * random.uniform() * random.direction();
        poses.push_back(pose);
      }
      PoseRule rule;
      rule.score = score;
      const GroupingResult result = choose(problem.matches, poses, rule);
      rule.keep = 1;  // judges them all
      const GroupingResult all = choose(problem.matches, poses, rule);
      EXPECT_EQ(result.selected, all.selected);
      EXPECT_EQ(result.target_from_source->translation, all.target_from_source->translation);
    }
}

TEST(PoseChoice, RunnersUpAreFarFromTheChosenAndFromEachOther) {
  PoseRule rule;
  rule.keep = 3;
  const auto found =
      choose(corners(), {shift(0), shift(1), shift(10), shift(80, 80, 100), shift(11), shift(15), shift(-10.5)}, rule);
  ASSERT_THAT(found.runner_up, SizeIs(3));
  EXPECT_EQ(found.runner_up[0].target_from_source.translation.x(), 80);  // a row of its own
  EXPECT_EQ(found.runner_up[0].score, 1);
  EXPECT_EQ(found.runner_up[1].target_from_source.translation.x(), 11);
  EXPECT_EQ(found.runner_up[2].target_from_source.translation.x(), -10.5);
}

TEST(PoseChoice, RefitNeverMakesItWorse) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticProblem problem = testing::synthetic(100, 0.4, seed);
    RigidTransform start = problem.truth;
    start.translation += Eigen::Vector3d(3, 0, 0);
    for (const PoseScore score : {PoseScore::Inliers, PoseScore::Mae}) {
      const PoseScorer scorer(problem.matches, score, 5);
      const auto worth = [&](const RigidTransform& pose) {
        std::vector<double> residuals;
        measure_residuals(problem.matches, pose, residuals);
        return scorer(residuals);
      };
      const RigidTransform end = refit(problem.matches, start, scorer, 5, 20);
      EXPECT_GE(worth(end), worth(start));
      EXPECT_LT(point_error(end, problem.truth, problem.matches.source_points, 1)->rmse_pr,
                point_error(start, problem.truth, problem.matches.source_points, 1)->rmse_pr);
      EXPECT_EQ(refit(problem.matches, start, scorer, 5, 0).translation, start.translation);
    }
  }
}

TEST(PoseChoice, FsCountsPartnersThatKeepTheirDistances) {
  PoseRule rule;
  rule.score = PoseScore::Fs;
  rule.keep = 5;
  EXPECT_EQ(choose(corners(), {shift(80, 80, 100), shift(0)}, rule).selected.size(), 4U);
  // The second row of the first point is nearer in features but does not fit; the partner must be within 1.5 tau.
  CorrespondenceSet table = corners();
  table.source_points.row(4).setZero();
  table.feature_distance = testing::column_of({0.5, 0.1, 0.1, 0.1, 0.2});
  EXPECT_THAT(choose(table, {shift(0.5)}, rule).selected, ElementsAre(0, 1, 2, 3));
}

/// Two poses that as many rows agree with; under the second the rows also agree with each other.
TEST(PoseChoice, FsPrefersRowsThatAgreeWithEachOther) {
  CorrespondenceSet table = testing::table_of_points(
      {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}, {0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}},
      {{4, 0, 0}, {26, 0, 0}, {0, 26, 0}, {0, 0, 26}, {90, 0, 0}, {120, 0, 0}, {90, 30, 0}, {90, 0, 30}});
  for (int row = 0; row < 8; ++row) table.source_points(row, 0) += row < 4 ? 0 : 1e-3;  // points of their own
  PoseRule rule;
  rule.score = PoseScore::Fs;
  const GroupingResult found = choose(table, {shift(0), shift(94)}, rule);
  EXPECT_THAT(found.selected, ElementsAre(4, 5, 6, 7));
}

}  // namespace
}  // namespace corral
