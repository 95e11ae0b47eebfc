// SPDX-License-Identifier: MIT
#include "grouping/tcf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grouping/columns/canonical_order.h"
#include "kernel/evaluation.h"
#include "tests/support/reference/tcf.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing::synthetic;

CorrespondenceSet in_canonical_order(const CorrespondenceSet& matches) {
  return select_rows(matches, canonical_order(matches));
}

TEST(Tcf, AnswerIsThatOfTheReference) {
  std::size_t selected = 0;
  for (const int rows : {5, 20, 60, 150, 300})
    for (const double ratio : {0.05, 0.2, 0.6})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        TcfOptions options;
        options.seed = seed;
        options.max_trials = 500;
        const CorrespondenceSet matches = in_canonical_order(seed % 2 == 0 ? testing::harsh_table(rows, ratio, seed)
                                                                           : synthetic(rows, ratio, seed).matches);
        const GroupingResult found = group_by_tcf(matches, options);
        EXPECT_EQ(found.selected, reference::tcf(matches, options).rows) << rows << " " << ratio << " " << seed;
        selected += found.selected.size();
      }
  EXPECT_GT(selected, 1000U);
}

TEST(Tcf, ARigidSetIsKeptWhole) {
  const SyntheticProblem problem = synthetic(200, 1, 1);
  CorrespondenceSet matches = problem.matches;
  matches.target_points = problem.truth.apply(matches.source_points);
  EXPECT_THAT(group_by_tcf(matches).selected, SizeIs(200));
}

TEST(Tcf, AFewCorrectMatchesAmongManyAreFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SyntheticProblem problem = synthetic(1500, 0.03, seed);
    const GroupingResult result = group_by_tcf(problem.matches);
    ASSERT_TRUE(result.target_from_source) << seed;
    EXPECT_LT(point_error(*result.target_from_source, problem.truth, problem.matches.source_points, 1)->mean_pr, 2);
  }
}

TEST(Tcf, ManyMatchesAreSampled) {
  TcfOptions options;
  options.sample = 500;
  for (const double ratio : {0.3, 0.9}) {
    const SyntheticProblem problem = synthetic(6000, ratio, 2);
    const GroupingResult result = group_by_tcf(problem.matches, options);
    ASSERT_TRUE(result.target_from_source);
    EXPECT_LT(point_error(*result.target_from_source, problem.truth, problem.matches.source_points, 1)->mean_pr, 1);
    const auto score = score_grouping(label_correct(problem.matches, problem.truth, 4), result.selected);
    EXPECT_GT(score.recall.value(), 0.95);
  }
}

TEST(Tcf, NoAgreementIsNothing) {
  const std::vector<testing::Row3> apart = {{0, 0, 0}, {100, 0, 0}, {0, 300, 0}, {0, 0, 700}},
                                   wide = {{0, 0, 0}, {150, 0, 0}, {0, 400, 0}, {0, 0, 1500}};
  EXPECT_THAT(group_by_tcf(testing::table_of_points(apart, wide)).selected, IsEmpty());
  EXPECT_THAT(group_by_tcf(testing::table_on_line({0, 10, 20, 30, 40}, {0, 10, 20, 30, 40})).selected, IsEmpty());
}

}  // namespace
}  // namespace corral
