// SPDX-License-Identifier: MIT
#include "grouping/game_theory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/reference/game_theory.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pointwise;

GameTheoryOptions after(int rounds) {
  GameTheoryOptions options;
  options.rounds = rounds;
  return options;
}

/// Rows 0 and 1 move rigidly; the distances of row 2 to both are in the ratio 0.4.
CorrespondenceSet three_rows() {
  return testing::table_of_points({{-3, 0, 0}, {3, 0, 0}, {0, 4, 0}},
                                  {{-3, 0, 0}, {3, 0, 0}, {0, std::sqrt(12.5 * 12.5 - 9), 0}});
}

TEST(GameTheory, SharesAreThoseWorkedOutByHand) {
  EXPECT_THAT(group_by_game_theory(three_rows(), after(1)).scores,
              Pointwise(DoubleNear(5e-5), {0.3889, 0.3889, 0.2222}));
  EXPECT_THAT(group_by_game_theory(three_rows(), after(2)).scores,
              Pointwise(DoubleNear(5e-5), {0.4216, 0.4216, 0.1569}));
  const GroupingResult end = group_by_game_theory(three_rows());
  EXPECT_THAT(end.scores, Pointwise(DoubleNear(1e-9), {0.5, 0.5, 0.0}));
  EXPECT_THAT(end.selected, ElementsAre(0, 1));
}

TEST(GameTheory, NoPartnerIsNothing) {
  EXPECT_THAT(group_by_game_theory(testing::table_on_line({1}, {2})).selected, IsEmpty());
  EXPECT_THAT(group_by_game_theory(testing::table_on_line({1, 1, 1}, {2, 5, 9})).selected, IsEmpty());
}

TEST(GameTheory, RowsThatShareAPointCanBeRivals) {
  const CorrespondenceSet matches = testing::table_on_line({0, 0, 8}, {0, 0, 8});  // rows 0 and 1 are the same
  EXPECT_THAT(group_by_game_theory(matches).selected, ElementsAre(2));  // half of all, the others a quarter each
  GameTheoryOptions distinct;
  distinct.distinct = true;
  const CorrespondenceSet rivals = testing::table_on_line({0, 0, 10}, {0, 5, 10});
  EXPECT_GT(group_by_game_theory(rivals).scores[0], 0.3);
  EXPECT_EQ(group_by_game_theory(rivals, distinct).scores,
            group_by_game_theory(rivals).scores);  // their payoff is 0 as it is
  const CorrespondenceSet one_target = testing::table_on_line({0, 4, 10}, {0, 0, 10});
  EXPECT_EQ(group_by_game_theory(one_target, distinct).scores, group_by_game_theory(one_target).scores);
}

TEST(GameTheory, SharesAddUpAndGainsNeverFall) {
  const CorrespondenceSet matches = testing::harsh_table(150, 0.2, 5);
  double last = 0;
  for (int rounds = 1; rounds <= 30; ++rounds) {
    const std::vector<double> shares = group_by_game_theory(matches, after(rounds)).scores;
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
    const double gain = reference::mean_payoff(matches, shares);
    EXPECT_GE(gain, last - 1e-12);
    last = gain;
  }
}

TEST(GameTheory, AnswerIsThatOfTheReference) {
  for (const OtsuRule otsu : {OtsuRule::Exact, OtsuRule::Bins100})
    for (const int rows : {2, 7, 8, 9, 50, 200, 500})
      for (const double ratio : {0.05, 0.5}) {
        GameTheoryOptions options;
        options.otsu = otsu;
        options.distinct = rows % 2 == 0;
        const CorrespondenceSet matches = testing::harsh_table(rows, ratio, 6);
        const GroupingResult found = group_by_game_theory(matches, options);
        const reference::Selection expected = reference::game_theory(matches, options);
        EXPECT_EQ(found.selected, expected.rows) << rows;
        EXPECT_THAT(found.scores, Pointwise(DoubleNear(1e-12), expected.scores));
      }
}

}  // namespace
}  // namespace corral
