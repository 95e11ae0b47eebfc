// SPDX-License-Identifier: MIT
#include "kernel/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::points_of;
using testing::table_of_points;

constexpr double kPi = 3.14159265358979323846;

RigidTransform turn(double radians, const Eigen::Vector3d& axis) {
  return {Eigen::AngleAxisd(radians, axis).toRotationMatrix(), Eigen::Vector3d::Zero()};
}

TEST(LabelInliers, ThresholdIsInclusive) {
  CorrespondenceSet matches =
      table_of_points({{0, 0, 0}, {0, 0, 0}, {1, 1, 1}}, {{0, 4, 0}, {0, 4.0000001, 0}, {1, 1, 1}});
  EXPECT_THAT(label_correct(matches, {}, 4), ElementsAre(true, false, true));
  EXPECT_THAT(label_correct(matches, {}, 0), ElementsAre(false, false, true));
  matches.resolution = 0.5;
  EXPECT_THAT(label_correct(matches, {}, 8), ElementsAre(true, false, true));
  EXPECT_THAT(label_correct(matches, {}, 7.9), ElementsAre(false, false, true));
}

TEST(LabelInliers, SourceIsMovedByTheTruth) {
  RigidTransform truth = turn(kPi / 2, Eigen::Vector3d::UnitZ());
  truth.translation << 10, 0, 0;
  const CorrespondenceSet matches = table_of_points({{1, 0, 0}, {10, 1, 0}}, {{10, 1, 0}, {1, 0, 0}});
  EXPECT_THAT(label_correct(matches, truth, 0.001), ElementsAre(true, false));
}

TEST(LabelInliers, RefusesBadInput) {
  CorrespondenceSet matches = table_of_points({{0, 0, 0}}, {{0, 0, 0}});
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) EXPECT_THROW(label_correct(matches, {}, bad), InvalidInput);
  EXPECT_THAT(label_correct(table_of_points({}, {}), {}, 4), IsEmpty());
  matches.target_points(0, 0) = std::nan("");
  EXPECT_THROW(label_correct(matches, {}, 4), InvalidInput);
}

TEST(ScoreGrouping, CountsAndRatios) {
  const GroupingScore score = score_grouping({true, false, true, true, false, true}, {0, 1, 3});
  EXPECT_EQ(score.matches, 6);
  EXPECT_EQ(score.selected, 3);
  EXPECT_EQ(score.correct, 2);
  EXPECT_EQ(score.true_matches, 4);
  EXPECT_DOUBLE_EQ(*score.precision, 2.0 / 3);
  EXPECT_DOUBLE_EQ(*score.recall, 0.5);
  EXPECT_DOUBLE_EQ(*score.f1, 4.0 / 7);
}

TEST(ScoreGrouping, RatioWithoutDenominatorIsAbsent) {
  const GroupingScore nothing_selected = score_grouping({true, false}, {});
  EXPECT_FALSE(nothing_selected.precision.has_value());
  EXPECT_DOUBLE_EQ(nothing_selected.recall.value(), 0);
  EXPECT_DOUBLE_EQ(nothing_selected.f1.value(), 0);
  const GroupingScore nothing_true = score_grouping({false, false}, {1});
  EXPECT_DOUBLE_EQ(nothing_true.precision.value(), 0);
  EXPECT_FALSE(nothing_true.recall.has_value());
  EXPECT_FALSE(nothing_true.f1.has_value());
  for (const auto& labels : {std::vector<bool>{}, std::vector<bool>{false}}) {
    const GroupingScore nothing = score_grouping(labels, {});
    EXPECT_FALSE(nothing.precision.has_value() || nothing.recall.has_value() || nothing.f1.has_value());
  }
}

TEST(ScoreGrouping, BadRowsAreRefused) {
  const std::vector<bool> labels(5, true);
  for (const Indices& bad : {Indices{-1}, Indices{5}, Indices{0, 5}, Indices{1, 1}, Indices{2, 1}, Indices{-1, 0}})
    EXPECT_THROW(score_grouping(labels, bad), InvalidInput);
  EXPECT_NO_THROW(score_grouping(labels, {0, 1, 2, 3, 4}));
  EXPECT_THROW(score_grouping({}, {0}), InvalidInput);
}

/// Row i: a frame on the source, and on the target the one that the truth makes of it, turned by so many degrees more.
CorrespondenceSet table_of_frames(const RigidTransform& truth, const std::vector<double>& degrees) {
  RandomStream random(2);
  CorrespondenceSet table;
  for (const double turned : degrees) {
    table.source_frames.push_back(random.rotation());
    const Eigen::Matrix3d more = turn(turned * kPi / 180, random.direction()).rotation;
    table.target_frames.push_back(table.source_frames.back() * truth.rotation.transpose() * more.transpose());
  }
  table.source_points = table.target_points = Points::Zero(static_cast<Eigen::Index>(degrees.size()), 3);
  return table;
}

TEST(FrameRepeatability, CountsRightMatchesWithinTheLimit) {
  RandomStream random(3);
  const RigidTransform truth{random.rotation(), {1, 2, 3}};
  const CorrespondenceSet table = table_of_frames(truth, {0, 9.99, 10.01, 180, 1, 3});
  const FrameRepeatability all = frame_repeatability(table, truth, std::vector<bool>(6, true));
  EXPECT_EQ(all.compared, 6);
  EXPECT_EQ(all.agreeing, 4);
  EXPECT_DOUBLE_EQ(all.share().value(), 4.0 / 6);
  const FrameRepeatability some = frame_repeatability(table, truth, {true, false, true, true, false, false});
  EXPECT_EQ(some.compared, 3);
  EXPECT_EQ(some.agreeing, 1);
  EXPECT_EQ(frame_repeatability(table, truth, std::vector<bool>(6, true), 2).agreeing, 2);
  EXPECT_EQ(frame_repeatability(table, truth, std::vector<bool>(6, true), 180).agreeing, 6);
  EXPECT_EQ(frame_repeatability(table, {}, std::vector<bool>(6, true), 1).agreeing, 0) << "under another motion";
}

TEST(FrameRepeatability, WithoutAFrameThereIsNothingToCompare) {
  CorrespondenceSet table = table_of_frames({}, {0, 0, 0, 0});
  table.source_frames[0].setZero();
  table.target_frames[1].setConstant(std::nan(""));
  table.target_frames[2].row(1) *= -1;  // left-handed
  const FrameRepeatability found = frame_repeatability(table, {}, std::vector<bool>(4, true));
  EXPECT_EQ(found.compared, 1);
  EXPECT_EQ(found.agreeing, 1);
  EXPECT_FALSE(frame_repeatability(table, {}, std::vector<bool>(4, false)).share().has_value());
  table.target_frames.clear();
  EXPECT_EQ(frame_repeatability(table, {}, std::vector<bool>(4, true)).compared, 0);
  EXPECT_FALSE(frame_repeatability({}, {}, {}).share().has_value());
}

TEST(RotationError, IsAccurateAtBothEnds) {
  RandomStream random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const RigidTransform truth{random.rotation(), random.direction()};
    const Eigen::Vector3d axis = random.direction();
    for (const double angle : {1e-9, 1e-6, 0.01, 1.0, 2.0, 3.0, kPi - 1e-3, kPi - 1e-6}) {
      const RigidTransform estimate = turn(angle, axis) * truth;
      // The rotations themselves are rounded at 1e-16 or so.
      EXPECT_NEAR(rotation_error_deg(estimate, truth) * kPi / 180, angle, 1e-14) << angle;
      EXPECT_NEAR(rotation_error_deg(truth, estimate) * kPi / 180, angle, 1e-14) << angle;
    }
    EXPECT_NEAR(rotation_error_deg(turn(kPi, axis) * truth, truth), 180, 1e-7);
    EXPECT_LE(rotation_error_deg(turn(kPi, axis) * truth, truth), 180);
    EXPECT_LT(rotation_error_deg(truth, truth), 1e-13);
  }
}

TEST(TranslationError, IsInResolutions) {
  RigidTransform estimate, truth;
  estimate.translation << 3, 4, 0;
  estimate.rotation = turn(1, Eigen::Vector3d::UnitX()).rotation;
  EXPECT_DOUBLE_EQ(translation_error_pr(estimate, truth, 0.5), 10);
  EXPECT_EQ(translation_error_pr(estimate, estimate, 0.5), 0);
}

TEST(PointError, RootMeanSquareAndMean) {
  // Half a turn about z: a point at distance r from the axis moves by 2 r.
  const RigidTransform estimate = turn(kPi, Eigen::Vector3d::UnitZ());
  const auto error = point_error(estimate, {}, points_of({{0, 0, 5}, {3, 0, 1}, {0, 4, 0}}), 2);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->mean_pr, (0 + 3 + 4) / 3.0, 1e-14);
  EXPECT_NEAR(error->rmse_pr, std::sqrt((9 + 16) / 3.0), 1e-14);
}

TEST(PointError, WithoutPointsIsAbsent) {
  EXPECT_FALSE(point_error({}, {}, Points(0, 3), 1).has_value());
  const auto none = point_error({}, {}, points_of({{1, 2, 3}}), 1);
  EXPECT_EQ(none->rmse_pr, 0);
  EXPECT_EQ(none->mean_pr, 0);
}

TEST(PointError, EqualTranslationsFarAwayCancel) {
  RigidTransform estimate, truth;
  estimate.translation << 1e7, 0, 0;
  truth.translation << 1e7, 0, 1;
  const auto error = point_error(estimate, truth, points_of({{1e7, 2, 3}, {4, 5, 6}}), 1);
  EXPECT_DOUBLE_EQ(error->rmse_pr, 1);
  EXPECT_DOUBLE_EQ(error->mean_pr, 1);
}

}  // namespace
}  // namespace corral
