// SPDX-License-Identifier: MIT
#include "apps/pair/evaluate_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <stdexcept>
#include <thread>

#include "kernel/error.h"
#include "kernel/synthetic.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

ConfiguredGrouper selecting(const Indices& rows) {
  return {[rows](const CorrespondenceSet&) { return GroupingResult{rows, {}, std::nullopt, {}, {}}; }, {}};
}

template <class Error>
ConfiguredGrouper throwing(const Error& error) {
  return {[error](const CorrespondenceSet&) -> GroupingResult { throw error; }, {}};
}

/// 60 right ones among 100 matches, without noise, and their truth over the source points of the right ones.
struct Problem {
  SyntheticProblem made;
  PairTruth truth;
};
Problem problem() {
  SyntheticOptions options;
  options.matches = 100;
  options.inlier_ratio = 0.6;
  options.noise_pr = 0;
  options.resolution = 0.25;
  Problem made{make_synthetic_problem(options), {}};
  made.truth.target_from_source = made.made.truth;
  made.truth.overlap = made.made.matches.source_points(made.made.inliers, Eigen::all);
  return made;
}

TEST(EvaluateMethod, ScoresRefinesAndJudges) {
  const Problem pair = problem();
  const MethodRecord record = evaluate_method("mine", selecting(pair.made.inliers), pair.made.matches, pair.truth, 1);
  EXPECT_EQ(record.method, "mine");
  EXPECT_EQ(record.failure, "");
  EXPECT_EQ(to_text(record.status()), "refined");
  EXPECT_EQ(record.found.selected, pair.made.inliers);
  EXPECT_EQ(record.score.value().precision, 1);
  EXPECT_EQ(record.score->selected, 60);
  EXPECT_LT(record.errors.value().rotation_error_deg, 1e-6);
  EXPECT_LT(record.errors->translation_error_pr, 1e-6);
  EXPECT_LT(record.errors->points.value().rmse_pr, 1e-6);
}

TEST(EvaluateMethod, WithoutATruthThereIsAPoseButNoScore) {
  const Problem pair = problem();
  const MethodRecord record = evaluate_method("mine", selecting(pair.made.inliers), pair.made.matches, std::nullopt, 1);
  EXPECT_FALSE(record.score.has_value());
  EXPECT_FALSE(record.errors.has_value());
  EXPECT_TRUE(record.pose.target_from_source.has_value());
}

TEST(EvaluateMethod, WithoutAPoseThereAreNoErrors) {
  const Problem pair = problem();
  for (const Indices& rows : {Indices{}, Indices{3}, Indices{3, 7}}) {
    const MethodRecord record = evaluate_method("mine", selecting(rows), pair.made.matches, pair.truth, 1);
    EXPECT_EQ(to_text(record.status()), "too few rows");
    EXPECT_FALSE(record.errors.has_value());
    EXPECT_EQ(record.score.value().selected, static_cast<int>(rows.size()));
    EXPECT_EQ(record.score->precision.has_value(), !rows.empty());
  }
}

TEST(EvaluateMethod, AMethodThatThrowsIsARecord) {
  const Problem pair = problem();
  const MethodRecord refused = evaluate_method("mine", throwing(InvalidInput("mine", "column x", "absent", "a column")),
                                               pair.made.matches, pair.truth, 1);
  EXPECT_EQ(refused.failure, "mine: column x is absent, expected a column");
  EXPECT_EQ(to_text(refused.status()), "failed: mine: column x is absent, expected a column");
  EXPECT_FALSE(refused.score.has_value());
  EXPECT_FALSE(refused.errors.has_value());
  EXPECT_FALSE(refused.pose.target_from_source.has_value());
  EXPECT_NE(evaluate_method("mine", throwing(std::bad_alloc()), pair.made.matches, pair.truth, 1).failure, "");
  EXPECT_EQ(
      to_text(evaluate_method("mine", throwing(std::runtime_error("no")), pair.made.matches, pair.truth, 1).status()),
      "failed: no");
}

TEST(EvaluateMethod, AMethodThatNeedsTooMuchMemoryIsARecordAndIsNotAsked) {
  const Problem pair = problem();
  ConfiguredGrouper greedy = throwing(std::runtime_error("asked"));
  greedy.working_memory = [](int matches) { return 1e6 * matches; };
  const MethodRecord refused = evaluate_method("mine", greedy, pair.made.matches, pair.truth, 1, 99e6);
  EXPECT_EQ(to_text(refused.status()), "too large: needs 100.0 MB, the limit is 99.0 MB");
  EXPECT_EQ(refused.failure_state, MethodState::TooLarge);
  EXPECT_FALSE(refused.score.has_value());
  EXPECT_FALSE(refused.pose.target_from_source.has_value());
  EXPECT_EQ(to_text(evaluate_method("mine", greedy, pair.made.matches, pair.truth, 1, 100e6).status()),
            "failed: asked");
}

TEST(EvaluateMethod, ASelectionThatIsNoneIsARecord) {
  const Problem pair = problem();
  for (const Indices& rows : {Indices{0, 1, 100}, Indices{-1, 0, 1}, Indices{5, 4, 3}})
    EXPECT_NE(evaluate_method("mine", selecting(rows), pair.made.matches, pair.truth, 1).failure, "");
}

TEST(TimeGrouping, GivesTheFirstAnswerAndTheMedianTime) {
  int calls = 0;
  const auto group = [&](const CorrespondenceSet&) {
    const int call = calls++;
    std::this_thread::sleep_for(std::chrono::milliseconds(call == 1 ? 200 : 2));
    return GroupingResult{{call}, {}, std::nullopt, {}, {}};
  };
  const TimedGrouping timed = time_grouping(group, CorrespondenceSet(), 3);
  EXPECT_EQ(calls, 3);
  EXPECT_THAT(timed.found.selected, ElementsAre(0));
  EXPECT_GE(timed.time_ms, 2);
  EXPECT_LT(timed.time_ms, 100) << "the one slow call does not count";
}

TEST(TimeGrouping, CallsAtLeastOnce) {
  int calls = 0;
  const auto group = [&](const CorrespondenceSet&) { return ++calls, GroupingResult{}; };
  for (const int repeat : {-1, 0, 1}) time_grouping(group, CorrespondenceSet(), repeat);
  EXPECT_EQ(calls, 3);
}

TEST(PoseErrors, AreInDegreesAndPr) {
  PairTruth truth;
  truth.overlap = Eigen::RowVector3d(1, 2, 3);
  RigidTransform estimate;
  estimate.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  estimate.translation << 0, 0, 3;
  const PoseErrors errors = pose_errors(estimate, truth, 0.5);
  EXPECT_NEAR(errors.rotation_error_deg, 90, 1e-12);
  EXPECT_NEAR(errors.translation_error_pr, 6, 1e-12);
  EXPECT_NEAR(errors.points.value().rmse_pr, 2 * std::sqrt(9.0 + 1 + 9), 1e-12);  // (1,2,3) goes to (-2,1,6)
  truth.overlap.resize(0, 3);
  EXPECT_FALSE(pose_errors(estimate, truth, 0.5).points.has_value());
}

TEST(PoseErrors, AddIsTheMeanOverAllVerticesInDiameters) {
  PairTruth truth;
  truth.vertices.resize(3, 3);
  truth.vertices << 0, 0, 5, 3, 0, 1, 0, 4, 0;
  truth.diameter = 10;
  RigidTransform estimate;  // half a turn about z: a point at distance r from the axis moves by 2 r
  estimate.rotation << -1, 0, 0, 0, -1, 0, 0, 0, 1;
  const PoseErrors errors = pose_errors(estimate, truth, 0.5);
  EXPECT_NEAR(errors.add_share.value(), (0 + 6 + 8) / 3.0 / 10, 1e-14);
  EXPECT_FALSE(errors.points.has_value());
  EXPECT_FALSE(pose_errors(estimate, PairTruth(), 0.5).add_share.has_value());
}

TEST(PoseErrors, AddSTakesTheNearestVertex) {
  Mesh square;
  square.vertices.resize(4, 3);
  square.vertices << 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0;
  const PairTruth truth = pair_truth(square, square, {}, 0.5, 4);
  RigidTransform estimate;  // a quarter of a turn about z, and a shift along it
  estimate.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  estimate.translation << 0, 0, 0.3;
  const PoseErrors errors = pose_errors(estimate, truth, 0.5);
  EXPECT_NEAR(errors.add_s_share.value(), 0.3 / 2, 1e-12);
  EXPECT_NEAR(errors.add_share.value(), std::sqrt(2 + 0.09) / 2, 1e-12);
  EXPECT_FALSE(pose_errors(estimate, PairTruth(), 0.5).add_s_share.has_value());
}

TEST(PairTruth, KnowsTheOverlapAndTheExtentOfTheSource) {
  Mesh source, target;
  source.vertices.resize(3, 3);
  source.vertices << 0, 0, 0, 3, 4, 0, 0, 0, 1;
  target.vertices = Eigen::RowVector3d(0, 0, 5);
  const RigidTransform up{Eigen::Matrix3d::Identity(), {0, 0, 4}};
  const PairTruth truth = pair_truth(source, target, up, 0.25, 3);
  EXPECT_EQ(truth.vertices, source.vertices);
  EXPECT_EQ(truth.diameter, std::sqrt(26.0));
  EXPECT_EQ(truth.threshold_pr, 3);
  ASSERT_EQ(truth.overlap.rows(), 2) << "4 pr are 1 mesh unit";
  EXPECT_EQ(truth.overlap.row(1), source.vertices.row(2));
}

TEST(EvaluateMethod, JudgesTheFitToo) {
  const Problem pair = problem();
  Indices rows = pair.made.inliers;
  const MethodRecord all = evaluate_method("mine", selecting(rows), pair.made.matches, pair.truth, 1);
  EXPECT_LT(all.initial_errors.value().points.value().mean_pr, 1e-6);
  for (int row = 0; row < 100; ++row)
    if (std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(row);
  std::sort(rows.begin(), rows.end());
  const MethodRecord mixed = evaluate_method("mine", selecting(rows), pair.made.matches, pair.truth, 1);
  EXPECT_GT(mixed.initial_errors.value().points.value().mean_pr, 1) << "gross errors pull the fit away";
  EXPECT_LT(mixed.errors.value().points.value().mean_pr, mixed.initial_errors->points->mean_pr);
}

TEST(IsRegistered, UpToTheLastThresholdOfTheCurve) {
  EXPECT_EQ(kSuccessPr, success_thresholds_pr().back());
  PoseErrors errors;
  EXPECT_FALSE(is_registered(std::nullopt));
  EXPECT_FALSE(is_registered(errors));
  errors.points = PointError{99, 5};
  EXPECT_TRUE(is_registered(errors)) << "the mean decides, inclusive";
  errors.points = PointError{5, std::nextafter(5.0, 6.0)};
  EXPECT_FALSE(is_registered(errors));
  errors.points = PointError{1, std::nan("")};
  EXPECT_FALSE(is_registered(errors));
}

TEST(MethodRecord, TheOutcomeTellsTheGrouperFromTheOptimiser) {
  MethodRecord record;
  EXPECT_EQ(record.outcome(), "") << "no truth";
  record.score = GroupingScore();
  EXPECT_EQ(record.outcome(), "lost");
  const PoseErrors near{0, 0, PointError{1, 1}, {}, {}}, far{0, 0, PointError{6, 6}, {}, {}};
  record.initial_errors = far, record.errors = near;
  EXPECT_EQ(record.outcome(), "saved");
  record.initial_errors = near;
  EXPECT_EQ(record.outcome(), "found");
  record.errors = far;
  EXPECT_EQ(record.outcome(), "spoiled");
  record.errors.reset();
  EXPECT_EQ(record.outcome(), "spoiled");
  record.failure = "no";
  EXPECT_EQ(record.outcome(), "");
}

}  // namespace
}  // namespace corral
