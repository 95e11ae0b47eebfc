// SPDX-License-Identifier: MIT
#include "apps/results/found_statements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/successes.h"

namespace corral::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<FoundStatement> found_in(const StudyFolder& run, std::size_t most = 10) {
  const std::vector<StudyFolder> runs = {run};
  return found_statements(set_tables(tables_of(runs)), most);
}

/// 20 pairs of 3 % and 20 of 60 % of correct matches.
StudyFolder mixed_study() {
  std::vector<int> correct(20, 3);
  correct.insert(correct.end(), 20, 60);
  const auto halves = [](int hard, int easy) {
    std::vector<bool> all = first_of(hard, 20), more = first_of(easy, 20);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  return successes_study("e", correct,
                         {{"gc", {halves(2, 20), halves(0, 10), 0.9, 0.3}},
                          {"ransac", {halves(16, 20), {}, 0.5, 0.5}},
                          {"ss", {halves(0, 4), {}, 0.2, 0.95}},
                          {"oracle", {halves(20, 20), {}, 1, 1}}});
}

TEST(FoundStatements, CompareSuccessOnTheSamePairs) {
  const std::vector<FoundStatement> found = found_in(mixed_study());
  ASSERT_EQ(found.size(), 5U);
  EXPECT_EQ(found[0].text, "Refinement raises the share of pairs that gc registers: 0.55 against 0.25");
  EXPECT_NEAR(found[0].margin, 0.3, 1e-12);
  EXPECT_EQ(found[0].pairs, 40);
  EXPECT_TRUE(found[0].is_clear());
  EXPECT_LT(found[0].low, 0.3);
  EXPECT_GT(found[0].high, 0.3);
  EXPECT_EQ(found[1].text, "All correct matches register more pairs than the best grouper, ransac: 1.00 against 0.90");
  EXPECT_EQ(found[2].text,
            "From 2 to 5 % of correct matches on a grouper registers half of the pairs; there ransac registers most, "
            "before gc: "
            "0.80 against 0.10");
  EXPECT_EQ(found[2].pairs, 20);
  EXPECT_THAT(found[3].text, HasSubstr("more pairs than gc, the most precise (0.90): 0.90 against 0.55"));
  EXPECT_THAT(found[4].text, HasSubstr("more pairs than ss, that with the best recall (0.95): 0.90 against 0.10"));
  EXPECT_EQ(found_in(mixed_study(), 2).size(), 2U);
}

TEST(FoundStatements, AnOppositeIsSaidAndNothingIsLeftOut) {
  const std::vector<int> correct(12, 60);
  const std::vector<FoundStatement> found = found_in(
      successes_study("e", correct, {{"gc", {first_of(2, 12), first_of(11, 12)}}, {"oracle", {first_of(2, 12)}}}));
  ASSERT_EQ(found.size(), 1U) << "the oracle registers as many, no grouper half of them";
  EXPECT_LT(found[0].high, 0);
  EXPECT_FALSE(found[0].is_clear());
  EXPECT_THAT(found_in(successes_study("e", {60, 60}, {{"gc", {{true, true}, {false, false}}}})), IsEmpty())
      << "two pairs";
}

}  // namespace
}  // namespace corral::testing
