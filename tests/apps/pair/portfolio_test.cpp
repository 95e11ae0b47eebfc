// SPDX-License-Identifier: MIT
#include "apps/pair/portfolio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/pair/confidence.h"
#include "kernel/evaluation.h"
#include "kernel/synthetic.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using testing::Workplace;

SyntheticProblem table(double share) {
  SyntheticOptions options;
  options.matches = 300;
  options.inlier_ratio = share;
  options.noise_pr = 0.5;
  return make_synthetic_problem(options);
}

TEST(Portfolio, StopsAtASurePose) {
  const SyntheticProblem problem = table(0.4);
  const GroupingResult found = group_by_portfolio(problem.matches);
  ASSERT_TRUE(found.target_from_source);
  EXPECT_LT(rotation_error_deg(*found.target_from_source, problem.truth), 1);
  EXPECT_GE(found.confidence.value(), 0.9);
  EXPECT_LT(found.notes.at(0).count, 6);
  EXPECT_GE(found.notes.at(0).count, 2);
  EXPECT_EQ(found.selected, agreeing_rows(problem.matches, *found.target_from_source));
}

TEST(Portfolio, AsksAllWhereNoneIsSure) {
  const GroupingResult found = group_by_portfolio(table(0).matches);
  EXPECT_EQ(found.notes.at(0).count, 6);
  EXPECT_LT(found.confidence.value_or(0), 0.5);
}

TEST(Portfolio, AsksMoreForMoreConfidence) {
  const SyntheticProblem problem = table(0.1);
  const auto asked = [&](double confidence) {
    PortfolioOptions options;
    options.confidence = confidence;
    return group_by_portfolio(problem.matches, options).notes.at(0).count;
  };
  EXPECT_EQ(asked(0), 2);
  EXPECT_EQ(asked(1), 6);
}

TEST(Portfolio, HasNothingWithoutMatches) {
  for (const int rows : {0, 1, 2}) {
    SyntheticOptions options;
    options.matches = rows;
    const GroupingResult found = group_by_portfolio(make_synthetic_problem(options).matches);
    EXPECT_TRUE(found.selected.empty());
    EXPECT_FALSE(found.target_from_source);
    EXPECT_FALSE(found.confidence);
  }
}

TEST(Portfolio, IsAMethodLikeAnyOther) {
  const Workplace place;
  place.put_problem();
  const auto outcome = place.corral("run --matches matches.csv --methods gc,auto,register --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto methods = outcome.json()["methods"];
  ASSERT_EQ(methods.size(), 3U);
  for (const auto& method : methods) EXPECT_GT(method["confidence"].get<double>(), 0.5) << method["method"];
  EXPECT_EQ(outcome.json()["best"]["verdict"], "trust it");
  EXPECT_EQ(place.corral("group matches.csv --method auto --set auto.confidence=2 -o a.csv").status, 2);
  EXPECT_EQ(place.corral("run --matches matches.csv --methods register --set register.keep=1").status, 2);
}

TEST(RatePoses, AMovedPoseIsLessProbable) {
  const SyntheticProblem problem = table(0.3);
  std::vector<MethodRecord> records(2);
  records[0].pose.target_from_source = records[1].pose.target_from_source = problem.truth;
  records[1].pose.target_from_source->translation.x() += 50 * problem.matches.resolution;
  const auto signals = rate_poses(records, problem.matches);
  EXPECT_GT(records[0].confidence.value(), 0.9);
  EXPECT_LT(records[1].confidence.value(), 0.1);
  EXPECT_TRUE(signals[0] && signals[1]);
}

TEST(RatePoses, LeavesWhatHasNoPoseOrAProbability) {
  const SyntheticProblem problem = table(0.3);
  std::vector<MethodRecord> records(2);
  records[1].pose.target_from_source = problem.truth;
  records[1].confidence = 0.25;
  rate_poses(records, problem.matches);
  EXPECT_FALSE(records[0].confidence);
  EXPECT_EQ(records[1].confidence, 0.25);
}

}  // namespace
}  // namespace corral
