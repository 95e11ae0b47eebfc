// SPDX-License-Identifier: MIT
#include "grouping/pose/possible_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grouping/pose/pose_score.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

std::vector<float> places(const FilterTable& table) { return {table.source(0), table.source(0) + table.rows()}; }

/// Rows 0 to 3 keep their distances to 9 or less, row 4 to one of them, row 5 to none.
CorrespondenceSet on_a_line() { return testing::table_on_line({0, 16, 32, 48, 64, 24}, {0, 16, 32, 57, 80, -64}); }

TEST(PossibleSupport, LeavesRowsWithEnoughPartners) {
  const CorrespondenceSet matches = on_a_line();
  const std::vector<double> residuals = {1, 2, 3, 4, 5, 6};
  PossibleSupport support(matches, 4.6, 1e-3);
  EXPECT_EQ(support.rows().rows(), 6);
  support.exceed(1, residuals);  // sets of two and more
  EXPECT_EQ(support.rows().rows(), 5);
  support.exceed(3, residuals);
  const std::vector<float> all = places(FilterTable(matches));
  EXPECT_THAT(places(support.rows()), UnorderedElementsAre(all[0], all[1], all[2], all[3]));
}

TEST(PossibleSupport, TwoToleranceAreStillTooFar) {
  PossibleSupport support(on_a_line(), 4.4, 1e-3);  // row 3 is off by 9
  support.exceed(3, std::vector<double>(6, 1));
  EXPECT_LT(support.rows().rows(), 4);
}

TEST(PossibleSupport, HoldsEverySetThatOneMotionAgreesWith) {
  for (const double factor : {1.0, 1e-30, 1e50})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SyntheticOptions options;
      options.matches = 300;
      options.inlier_ratio = 0.4;
      options.noise_pr = 2;
      options.seed = seed;
      const SyntheticProblem problem = make_synthetic_problem(options);
      CorrespondenceSet matches = testing::scaled(problem.matches, factor);
      std::vector<double> residuals;
      measure_residuals(problem.matches, problem.truth, residuals);
      const Indices agreeing = rows_within(residuals, 5);
      PossibleSupport support(matches, 5 * matches.resolution, 1e-3 * matches.resolution * matches.resolution);
      support.exceed(static_cast<int>(agreeing.size()) - 1, residuals);
      EXPECT_GE(support.rows().rows(), static_cast<int>(agreeing.size()));
      EXPECT_LT(support.rows().rows(), 200);
      const std::vector<float> all = places(FilterTable(matches)), left = places(support.rows());
      for (const int row : agreeing)
        EXPECT_TRUE(std::count(left.begin(), left.end(), all[static_cast<std::size_t>(row)]) > 0) << row;
    }
}

TEST(PossibleSupport, NothingIsLeftOutWhereTheProofDoesNotHold) {
  for (const double factor : {1e-70, 1e70}) {
    const CorrespondenceSet matches = testing::scaled(testing::synthetic(100, 0.3, 1).matches, factor);
    PossibleSupport support(matches, 5 * matches.resolution, 1e-3 * matches.resolution * matches.resolution);
    support.exceed(90, std::vector<double>(100, 1));
    EXPECT_EQ(support.rows().rows(), 100);
  }
}

TEST(PossibleSupport, RowsThatTheBestPoseMissesComeFirst) {
  const SyntheticProblem problem = testing::synthetic(400, 1, 2);
  std::vector<double> residuals(400, 1);
  residuals[123] = residuals[321] = 9;
  PossibleSupport support(problem.matches, 5, 1e-3);
  support.exceed(350, residuals);
  ASSERT_EQ(support.rows().rows(), 400);
  const std::vector<float> all = places(FilterTable(problem.matches)), left = places(support.rows());
  const auto first = left.begin() + 400 - 350 + 64;
  EXPECT_NE(std::find(left.begin(), first, all[123]), first);
  EXPECT_NE(std::find(left.begin(), first, all[321]), first);
}

}  // namespace
}  // namespace corral
