// SPDX-License-Identifier: MIT
#include "grouping/pose/pose_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

double score_of(PoseScore score, const std::vector<double>& residuals, const CorrespondenceSet& table) {
  return PoseScorer(table, score, 5)(residuals);
}

TEST(PoseScore, AreTheSumsOfTheirDefinitions) {
  const std::vector<double> residuals = {0, 1, 2.5, 4, 5, 9};  // those of 5 and 9 are not below the tolerance
  CorrespondenceSet table = testing::table_on_line({0, 0, 0, 0, 0, 0}, {1, 2, 3, 4, 5, 6});
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Inliers, residuals, table), 4);
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Mae, residuals, table), 1 + 0.8 + 0.5 + 0.2);
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Mse, residuals, table), 1 + 0.64 + 0.25 + 0.04);
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Msac, residuals, table), 1 + 0.96 + 0.75 + 0.36);
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Oamae, residuals, table), 1 + 0.8 + 0.5 + 0.2);
}

TEST(PoseScore, OamaeTakesTheMeanOfEachTargetPoint) {
  const CorrespondenceSet table = testing::table_on_line({0, 0, 0, 0, 0}, {7, 3, 7, 7, 3});
  EXPECT_DOUBLE_EQ(score_of(PoseScore::Oamae, {1, 2, 3, 8, 5}, table), (0.8 + 0.4) / 2 + 0.6);
}

TEST(PoseScore, NaNDoesNotAgree) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CorrespondenceSet table = testing::table_on_line({0, 0}, {1, 2});
  for (const PoseScore score : {PoseScore::Inliers, PoseScore::Mae, PoseScore::Mse, PoseScore::Msac, PoseScore::Oamae})
    EXPECT_DOUBLE_EQ(score_of(score, {nan, 0}, table), 1);
  EXPECT_THAT(rows_within({nan, 0, 5, 4.9}, 5), ElementsAre(1, 3));
}

TEST(PoseScore, ResidualsAreThoseOfThePlainForm) {
  for (const int rows : {1, 7, 8, 9, 100}) {
    const SyntheticProblem problem = testing::synthetic(rows, 0.5, 3);
    std::vector<double> residuals;
    measure_residuals(problem.matches, problem.truth, residuals);
    ASSERT_EQ(residuals.size(), static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) {
      const Eigen::Vector3d p = problem.matches.source_points.row(row), q = problem.matches.target_points.row(row);
      EXPECT_NEAR(residuals[static_cast<std::size_t>(row)], (problem.truth * p - q).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace corral
