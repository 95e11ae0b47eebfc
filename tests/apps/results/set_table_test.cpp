// SPDX-License-Identifier: MIT
#include "apps/results/set_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/successes.h"

namespace corral::testing {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> names_of(const std::vector<MethodShare>& shares) {
  std::vector<std::string> names;
  for (const MethodShare& share : shares) names.push_back(share.method);
  return names;
}

TEST(SetTable, EveryPairOnceFromTheExperimentWithTheMostMethods) {
  const std::vector<StudyFolder> runs = {
      successes_study("small", {10, 20, 30}, {{"gc", {{false, false, true}}}}),
      successes_study("large", {10, 20}, {{"gc", {{true, true}}}, {"st", {{true, false}}}, {"oracle", {{true, true}}}}),
  };
  const std::vector<SetTable> tables = set_tables(tables_of(runs));
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_THAT(tables[0].pairs, ElementsAre("p0", "p1", "p2"));
  EXPECT_THAT(tables[0].methods, ElementsAre("gc", "st", "oracle"));
  EXPECT_THAT(tables[0].column("gc", "success_5pr"), ElementsAre(1, 1, 1)) << "p0 and p1 of large, p2 of small";
  EXPECT_EQ(tables[0].column("st", "success_5pr")[1], 0);
  EXPECT_TRUE(std::isnan(tables[0].column("st", "success_5pr")[2]));
  EXPECT_EQ(tables[0].correct_share[2], 0.3);
}

TEST(SetTable, TheFrontIsOfMethodsThatNoOtherIsAsGoodAndFasterThan) {
  const std::vector<int> correct(20, 40);
  const std::vector<StudyFolder> runs = {successes_study("e", correct,
                                                         {{"best", {first_of(18, 20), {}, 0.1, 0.1, 10}},
                                                          {"equal-slow", {first_of(18, 20), {}, 0.1, 0.1, 20}},
                                                          {"fast", {first_of(10, 20), {}, 0.1, 0.1, 1}},
                                                          {"worse", {first_of(9, 20), {}, 0.1, 0.1, 2}}})};
  const MethodChoice choice = choose_method(set_tables(tables_of(runs)).front());
  EXPECT_THAT(names_of(choice.methods), ElementsAre("best", "equal-slow", "fast", "worse"));
  EXPECT_THAT(choice.is_on_front, ElementsAre(true, false, true, false));
  EXPECT_FALSE(choice.perfect);
  EXPECT_EQ(choice.methods[0].success, 0.9);
  EXPECT_NEAR(choice.methods[0].low, 0.699, 1e-3);
  EXPECT_EQ(choice.methods[0].median_ms, 10);
}

TEST(SetTable, CellsNameTheBestAndItsTies) {
  std::vector<int> correct(20, 1);
  correct.insert(correct.end(), 20, 50);
  std::vector<bool> strong = first_of(12, 20), weak(20, false), both = first_of(19, 20), nearly = first_of(18, 20);
  strong.insert(strong.end(), nearly.begin(), nearly.end());
  weak.insert(weak.end(), both.begin(), both.end());
  const std::vector<StudyFolder> runs = {successes_study("e", correct, {{"strong", {strong}}, {"weak", {weak}}})};
  const MethodChoice choice = choose_method(set_tables(tables_of(runs)).front());
  const ChoiceCell &hard = choice.cells[1][0], &easy = choice.cells[6][0];  // 1 to 2 %, 50 to 100 %, up to 300 matches
  EXPECT_EQ(hard.pairs, 20);
  EXPECT_THAT(names_of(hard.best), ElementsAre("strong")) << "0 of 20 is told from 12";
  EXPECT_THAT(names_of(easy.best), ElementsAre("weak", "strong")) << "18 of 20 is not told from 19";
  EXPECT_EQ(choice.cells[0][0].pairs, 0);
  EXPECT_EQ(correct_share_text(1), "1 to 2 %");
  EXPECT_EQ(match_count_text(3), "3000 and more");
}

}  // namespace
}  // namespace corral::testing
