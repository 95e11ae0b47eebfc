// SPDX-License-Identifier: MIT
#include "grouping/frame_ransac.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::table_of_points;

void expect_nothing(const GroupingResult& result) {
  EXPECT_THAT(result.selected, IsEmpty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

FrameRansacOptions textbook() {
  FrameRansacOptions options;
  options.polish = 0;
  return options;
}

/// A quarter turn about z of four corners, and a stray row. Only the first row has frames.
CorrespondenceSet quarter_turn() {
  CorrespondenceSet table = table_of_points({{1, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                                            {{0, 1, 0}, {0, 20, 0}, {-20, 0, 0}, {0, 0, 20}, {100, 100, 100}});
  table.source_frames.assign(5, Eigen::Matrix3d::Zero());
  table.target_frames = table.source_frames;
  table.source_frames[0].setIdentity();
  table.target_frames[0] << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return table;
}

TEST(FrameRansac, OneMatchWithFramesIsEnough) {
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const FrameRansacOptions& options : {textbook(), FrameRansacOptions()}) {
    const GroupingResult result = group_by_frame_ransac(quarter_turn(), options);
    EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
    ASSERT_TRUE(result.target_from_source.has_value());
    EXPECT_TRUE(result.target_from_source->rotation.isApprox(turn, 1e-12));
    EXPECT_TRUE(result.target_from_source->translation.isZero(1e-12));
    EXPECT_THAT(result.scores, IsEmpty());
  }
}

TEST(FrameRansac, FramesThatAreNoneProposeNothing) {
  CorrespondenceSet table = quarter_turn();
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal();
  for (const Eigen::Matrix3d& invalid : {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), mirror}) {
    table.source_frames[0] = invalid;
    expect_nothing(group_by_frame_ransac(table));
    table.source_frames[0].setIdentity();
    table.source_frames[3] = invalid;
    EXPECT_THAT(group_by_frame_ransac(table).selected, ElementsAre(0, 1, 2, 3));
  }
  table.target_frames[0] = mirror;
  expect_nothing(group_by_frame_ransac(table));
}

TEST(FrameRansac, AbsentFramesAreNamed) {
  CorrespondenceSet table = quarter_turn();
  table.target_frames.clear();
  EXPECT_THAT(refusal_of([&] { group_by_frame_ransac(table); }), HasSubstr("target_frames"));
  table.source_frames.clear();
  EXPECT_THAT(refusal_of([&] { group_by_frame_ransac(table); }), HasSubstr("source_frames"));
}

TEST(FrameRansac, FewerThanThreeInAgreementAreNothing) {
  CorrespondenceSet table = quarter_turn();
  expect_nothing(group_by_frame_ransac(select_rows(table, {0, 1})));
  expect_nothing(group_by_frame_ransac(select_rows(table, {0, 1, 4})));
  EXPECT_THAT(group_by_frame_ransac(select_rows(table, {0, 1, 3})).selected, ElementsAre(0, 1, 2));
}

TEST(FrameRansac, ResidualBelowTheToleranceAgrees) {
  CorrespondenceSet table = quarter_turn();
  table.target_points(3, 2) += 4;
  FrameRansacOptions options = textbook();
  options.tolerance_pr = 4;
  EXPECT_THAT(group_by_frame_ransac(table, options).selected, ElementsAre(0, 1, 2));
  options.tolerance_pr = 4 + 1e-9;
  EXPECT_THAT(group_by_frame_ransac(table, options).selected, ElementsAre(0, 1, 2, 3));
  table.resolution = 2;
  options.tolerance_pr = 2;
  EXPECT_THAT(group_by_frame_ransac(table, options).selected, ElementsAre(0, 1, 2));
}

TEST(FrameRansac, NearlyRectangularFramesGiveARotation) {
  CorrespondenceSet table = quarter_turn();
  table.source_frames[0](0, 1) = 5e-5;
  const GroupingResult result = group_by_frame_ransac(table, textbook());
  ASSERT_TRUE(result.target_from_source.has_value());
  EXPECT_TRUE(is_rotation(result.target_from_source->rotation, 1e-12));
  const Eigen::Vector3d first = table.source_points.row(0), image = table.target_points.row(0);
  EXPECT_TRUE((*result.target_from_source * first - image).isZero(1e-12));
}

TEST(FrameRansac, PolishNeverLowersTheScoreAndMendsFrames) {
  double raw_error = 0, error = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SyntheticOptions of_problem;
    of_problem.matches = 150;
    of_problem.inlier_ratio = 0.3;
    of_problem.frame_noise_deg = 6;
    of_problem.seed = seed;
    const SyntheticProblem problem = make_synthetic_problem(of_problem);
    const auto off = [&](const GroupingResult& result) {
      return point_error(*result.target_from_source, problem.truth, problem.matches.source_points, 1)->rmse_pr;
    };
    const GroupingResult before = group_by_frame_ransac(problem.matches, textbook());
    std::size_t selected = before.selected.size();
    for (const int polish : {1, 5, 50, 1000}) {
      FrameRansacOptions options;
      options.polish = polish;
      const GroupingResult after = group_by_frame_ransac(problem.matches, options);
      EXPECT_GE(after.selected.size(), selected) << polish;
      selected = after.selected.size();
    }
    raw_error += off(before);
    error += off(group_by_frame_ransac(problem.matches));
  }
  EXPECT_LT(error, raw_error / 3);
}

/// Five matches stay; each proposes the same pose with the same five. One is moved by 300, three by 304 and three by 306: the
/// first of these alone has frames, and agrees with four of the seven until its pose is refitted.
TEST(FrameRansac, PosesWithTheSameMatchesAreRankedOnce) {
  std::vector<testing::Row3> source = {{0, 0, 0}, {40, 0, 0}, {0, 40, 0}, {0, 0, 40}, {40, 40, 40}}, target = source;
  const double moved[] = {300, 304, 304, 304, 306, 306, 306};
  const std::vector<testing::Row3> places = {{20, 20, 20}, {1, 0, 0},  {41, 40, 0}, {1, 40, 40},
                                             {41, 0, 40},  {41, 0, 0}, {1, 40, 0}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    source.push_back(places[i]);
    target.push_back({places[i][0] + moved[i], places[i][1], places[i][2]});
  }
  CorrespondenceSet table = table_of_points(source, target);
  testing::set_identity_frames(table);
  for (std::size_t row = 6; row < 12; ++row) table.source_frames[row].setZero();
  FrameRansacOptions options;
  options.polish = 1;
  EXPECT_THAT(group_by_frame_ransac(table, options).selected, ElementsAre(0, 1, 2, 3, 4));
  options.polish = 2;
  EXPECT_THAT(group_by_frame_ransac(table, options).selected, ElementsAre(5, 6, 7, 8, 9, 10, 11));
}

}  // namespace
}  // namespace corral
