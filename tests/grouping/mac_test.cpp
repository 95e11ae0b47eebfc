// SPDX-License-Identifier: MIT
#include "grouping/mac.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "tests/support/reference/mac.h"
#include "tests/support/row_order.h"
#include "tests/support/same_result.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing::table_of_points;

std::int64_t note(const GroupingResult& result, const std::string& name) {
  for (const Note& each : result.notes)
    if (each.name == name) return each.count;
  return -1;
}

/// Four corners that stay and one row that goes astray: six edges of weight 2, one clique.
CorrespondenceSet corners() {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                         {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
}

TEST(Mac, FourCornersAreOneClique) {
  const GroupingResult result = group_by_mac(corners());
  EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(note(result, "cliques"), 1);
  EXPECT_EQ(note(result, "hypotheses"), 1);
  EXPECT_EQ(note(result, "halvings"), -1);
  ASSERT_TRUE(result.target_from_source);
  EXPECT_TRUE(result.target_from_source->rotation.isIdentity(1e-12));
}

TEST(Mac, GateIsADifferenceOfDistances) {
  // One corner is moved outwards by 1.2, exp(-1.2^2 / 200) = 0.99283; its distances to the other two change by 0.86.
  CorrespondenceSet matches = corners();
  matches.target_points(1, 0) = 21.2;
  MacOptions options;
  options.gate = 0.9929;
  EXPECT_EQ(note(group_by_mac(matches, options), "cliques"), 2);
  options.gate = 0.9928;
  EXPECT_EQ(note(group_by_mac(matches, options), "cliques"), 1);
}

/// Two sets of rows that move apart; the lighter one is named by its own rows.
TEST(Mac, EveryRowNamesAClique) {
  const CorrespondenceSet matches =
      table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 0, 0}, {130, 0, 0}, {100, 30, 0}},
                      {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 0, 300}, {130, 0, 300}, {100, 30, 300}});
  MacOptions options;
  options.keep = 3;
  const GroupingResult result = group_by_mac(matches, options);
  EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(note(result, "hypotheses"), 2);
  ASSERT_THAT(result.runner_up, SizeIs(1));
  EXPECT_NEAR(result.runner_up[0].target_from_source.translation.z(), 300, 1e-9);
}

TEST(Mac, LargerTablesAreThoseOfTheReference) {
  for (const int rows : {60, 150, 250})
    for (const double inlier_ratio : {0.05, 0.1, 0.9})
      for (const int per_node : {1, 3}) {
        MacOptions options;
        options.cliques_per_node = per_node;
        const CorrespondenceSet matches = testing::harsh_table(rows, inlier_ratio, 4);
        const GroupingResult result = group_by_mac(matches, options);
        ASSERT_EQ(note(result, "halvings"), -1);
        testing::expect_reference(result, reference::mac(matches, options));
        EXPECT_EQ(note(result, "hypotheses"), reference::mac_hypotheses(matches, options));
      }
}

TEST(Mac, PastTheBoundHalfOfTheRowsIsSearched) {
  const CorrespondenceSet matches = testing::synthetic(120, 0.4, 2).matches;
  MacOptions options;
  const std::int64_t needed = note(group_by_mac(matches, options), "steps");
  ASSERT_GT(needed, 100);
  options.max_steps = static_cast<int>(needed);
  EXPECT_EQ(note(group_by_mac(matches, options), "halvings"), -1);
  options.max_steps = static_cast<int>(needed) - 1;
  EXPECT_EQ(note(group_by_mac(matches, options), "halvings"), 1);
  options.max_steps = 1;
  EXPECT_GE(note(group_by_mac(matches, options), "halvings"), 5);
}

TEST(Mac, HalvingsDoNotDependOnTheOrderOfTheRows) {
  MacOptions options;
  options.max_steps = 60;
  int halved = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const CorrespondenceSet matches = testing::harsh_table(90, 0.5, seed);
    const GroupingResult expected = group_by_mac(matches, options);
    halved += note(expected, "halvings") > 0;
    const Indices old_row = testing::shuffled_rows(matches.size(), seed);
    const GroupingResult found = group_by_mac(select_rows(matches, old_row), options);
    EXPECT_EQ(testing::by_old_name(found.selected, old_row), expected.selected);
    EXPECT_EQ(note(found, "halvings"), note(expected, "halvings"));
    EXPECT_EQ(note(found, "steps"), note(expected, "steps"));
  }
  EXPECT_GE(halved, 5);
}

TEST(Mac, FindsFewCorrectRowsAmongMany) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SyntheticProblem problem = testing::synthetic(1000, 0.02, seed);
    const GroupingResult result = group_by_mac(problem.matches);
    ASSERT_TRUE(result.target_from_source);
    EXPECT_LT(rotation_error_deg(*result.target_from_source, problem.truth), 3) << "seed " << seed;
  }
}

TEST(Mac, NothingToFindGivesNothing) {
  for (const auto& matches : {table_of_points({{0, 0, 0}, {9, 0, 0}}, {{0, 0, 0}, {9, 0, 0}}),
                              testing::table_on_line({0, 10, 25, 60}, {0, 100, 10, 500}),
                              testing::table_on_line({0, 10, 25, 60}, {0, 10, 25, 60})}) {
    const GroupingResult result = group_by_mac(matches);
    EXPECT_THAT(result.selected, IsEmpty());
    EXPECT_FALSE(result.target_from_source);
  }
}

}  // namespace
}  // namespace corral
