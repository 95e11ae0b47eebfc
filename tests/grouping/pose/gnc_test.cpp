// SPDX-License-Identifier: MIT
#include "grouping/pose/gnc.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kernel/evaluation.h"
#include "kernel/weighted_fit.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

/// c = 3 and a largest residual of 6: mu = 1 / (2 * 36 / 9 - 1).
TEST(Gnc, WeightsAreThoseWorkedOutByHand) {
  const double mu = 1.0 / 7;
  EXPECT_EQ(gnc_weight(72, 9, mu), 0);
  EXPECT_GT(gnc_weight(72 - 1e-6, 9, mu), 0);
  EXPECT_EQ(gnc_weight(1.125, 9, mu), 1);
  EXPECT_LT(gnc_weight(1.125 + 1e-6, 9, mu), 1);
  EXPECT_NEAR(gnc_weight(9, 9, mu), 0.2612, 5e-5);
  EXPECT_NEAR(gnc_weight(36, 9, mu), 0.0592, 5e-5);
  EXPECT_EQ(gnc_weight(0, 9, mu), 1);
}

Indices all_rows(const CorrespondenceSet& matches) {
  Indices rows(static_cast<std::size_t>(matches.size()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(Gnc, EndsAtTheFitOfTheRowsWithinTheBound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticProblem problem = testing::synthetic(60, 0.7, seed);
    const auto pose = fit_gnc(problem.matches, all_rows(problem.matches), 4);
    ASSERT_TRUE(pose);
    Indices within;
    for (int row = 0; row < 60; ++row)
      if ((*pose * problem.matches.source_points.row(row).transpose() -
           problem.matches.target_points.row(row).transpose())
              .norm() < 4)
        within.push_back(row);
    EXPECT_GE(within.size(), 40U) << "seed " << seed;
    const auto fit = fit_weighted(problem.matches, within, std::vector<double>(within.size(), 1.0));
    EXPECT_LT(point_error(*pose, *fit, problem.matches.source_points, 1)->rmse_pr, 0.05);
  }
}

TEST(Gnc, RowsThatAllFitAreFittedAlike) {
  const CorrespondenceSet matches = testing::synthetic(30, 1, 2).matches;
  const auto pose = fit_gnc(matches, all_rows(matches), 50),
             fit = fit_weighted(matches, all_rows(matches), std::vector<double>(30, 1.0));
  EXPECT_EQ(pose->rotation, fit->rotation);
  EXPECT_EQ(pose->translation, fit->translation);
}

TEST(Gnc, WithoutAModelThereIsNone) {
  const CorrespondenceSet line = testing::table_on_line({0, 10, 20, 30}, {0, 10, 20, 30});
  EXPECT_FALSE(fit_gnc(line, {0, 1, 2, 3}, 3));
  EXPECT_FALSE(fit_gnc(testing::full_table(), {0, 1}, 3));
  EXPECT_FALSE(fit_gnc(testing::full_table(), {}, 3));
}

}  // namespace
}  // namespace corral
