// SPDX-License-Identifier: MIT
#include "apps/report/reliability_figures.h"

#include <gtest/gtest.h>

namespace corral {
namespace {

const RatedPoses kRated{"gc", {0.95, 0.15, 0.95, 0.15}, {true, false, false, false}};

TEST(ReliabilityFigures, TheShareOfRightPosesStandsAtItsTenth) {
  Panel panel;
  draw_reliability({kRated, {"ss", {}, {}}}, panel);
  ASSERT_EQ(panel.series.size(), 1U) << "nothing is rated of ss";
  const auto& values = panel.series[0].values;
  EXPECT_EQ(panel.levels[9], "0.95");
  EXPECT_EQ(values[9].value, 0.5);
  EXPECT_EQ(values[1].value, 0);
  EXPECT_FALSE(values[5].value);
  EXPECT_NEAR(values[9].low.value(), 0.0945, 1e-4);
  EXPECT_NEAR(values[9].high.value(), 0.9055, 1e-4);
  EXPECT_EQ(panel.series_counts[0].cells[0], "4");
  EXPECT_EQ(panel.series_counts[1].cells[0], "0.237");  // (0.0025 + 0.9025 + 2 * 0.0225) / 4
  EXPECT_EQ(panel.series_counts[2].cells[0], "0.833");  // of three pairs, one ties
}

TEST(ReliabilityFigures, CoverageKeepsTheMostProbable) {
  Panel panel;
  draw_coverage({kRated}, panel);
  const auto& values = panel.series[0].values;
  EXPECT_EQ(values[0].value, 1) << "one pose of four";
  EXPECT_EQ(values[4].value, 0.5);
  EXPECT_EQ(values[9].value, 0.25);
}

TEST(ReliabilityFigures, OfRecordsWithAProbabilityAndATruth) {
  StudyRecord record;
  record.confidence = 0.8;
  EXPECT_TRUE(rated_poses("gc", {&record}).right.empty());
  record.refined.mean_error_pr = 4.9;
  EXPECT_TRUE(rated_poses("gc", {&record}).right.at(0));
  record.refined.mean_error_pr = 5.1;
  EXPECT_FALSE(rated_poses("gc", {&record}).right.at(0));
  record.confidence = std::nullopt;
  EXPECT_TRUE(rated_poses("gc", {&record}).right.empty());
}

}  // namespace
}  // namespace corral
