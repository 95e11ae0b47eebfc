// SPDX-License-Identifier: MIT
#include "grouping/similarity_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::refusal_of;
using testing::table_of_features;

TEST(SimilarityScore, KeepsTheUpperClassOfOneMinusDistance) {
  // s = 0.9, 0.35, 0.85, 0.4, 0.3: the gap 0.4 | 0.85 parts them best.
  const GroupingResult result = group_by_similarity_score(table_of_features({0.1, 0.65, 0.15, 0.6, 0.7}));
  EXPECT_THAT(result.selected, ElementsAre(0, 2));
  EXPECT_THAT(result.scores, ElementsAre(DoubleEq(1 - 0.1), DoubleEq(1 - 0.65), DoubleEq(1 - 0.15), DoubleEq(1 - 0.6),
                                         DoubleEq(1 - 0.7)));
  EXPECT_FALSE(result.target_from_source.has_value());
}

TEST(SimilarityScore, DistancesAboveOneScoreBelowZero) {
  // s = -0.4, -0.3, 0.5, 0.6
  const GroupingResult result = group_by_similarity_score(table_of_features({1.4, 1.3, 0.5, 0.4}));
  EXPECT_THAT(result.selected, ElementsAre(2, 3));
}

TEST(SimilarityScore, EqualScoresAreAllKept) {
  EXPECT_THAT(group_by_similarity_score(table_of_features({0.3, 0.3, 0.3, 0.3})).selected, ElementsAre(0, 1, 2, 3));
}

TEST(SimilarityScore, OtsuRuleIsAnOption) {
  // s = 0, 0.125, 0.126, 0.875, 1 in bins 0, 12, 12, 87, 99 of 100: bin 12 is the last of the lower class and accepted.
  const CorrespondenceSet matches = table_of_features({1, 0.875, 0.874, 0.125, 0});
  EXPECT_THAT(group_by_similarity_score(matches, {OtsuRule::Exact}).selected, ElementsAre(3, 4));
  EXPECT_THAT(group_by_similarity_score(matches, {OtsuRule::Bins100}).selected, ElementsAre(1, 2, 3, 4));
  // round(sqrt 5) = 2 bins hold 3 and 2; the threshold 0 / (2 - 1) is strict: only s = 0 goes.
  EXPECT_THAT(group_by_similarity_score(matches, {OtsuRule::Covis}).selected, ElementsAre(1, 2, 3, 4));
}

TEST(SimilarityScore, AbsentColumnIsNamed) {
  EXPECT_EQ(refusal_of([] { group_by_similarity_score(CorrespondenceSet()); }), "");  // an empty table lacks nothing
  const std::string refusal = refusal_of([] { group_by_similarity_score(testing::table_on_line({0, 1}, {0, 1})); });
  EXPECT_THAT(refusal, HasSubstr("ss"));
  EXPECT_THAT(refusal, HasSubstr("column feature_distance"));
}

}  // namespace
}  // namespace corral
