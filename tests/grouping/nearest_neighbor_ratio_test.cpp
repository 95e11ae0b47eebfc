// SPDX-License-Identifier: MIT
#include "grouping/nearest_neighbor_ratio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::table_of_features;

NearestNeighborRatioOptions options_of(double threshold, RatioRule rule) {
  NearestNeighborRatioOptions options;
  options.threshold = threshold;
  options.ratio = rule;
  return options;
}

TEST(NearestNeighborRatio, LimitIsIncluded) {
  // d1/d2 = 4/5, a little above, a little below, 0/1, 1
  const CorrespondenceSet matches = table_of_features({4, 4.001, 3.999, 0, 2}, {5, 5, 5, 1, 2});
  const GroupingResult result = group_by_nearest_neighbor_ratio(matches);
  EXPECT_THAT(result.selected, ElementsAre(0, 2, 3));
  EXPECT_THAT(result.scores, ElementsAre(1 - 4.0 / 5, 1 - 4.001 / 5, 1 - 3.999 / 5, 1, 0));
  EXPECT_FALSE(result.target_from_source.has_value());
}

TEST(NearestNeighborRatio, WithoutSecondFeatureNeverKept) {
  const CorrespondenceSet matches = table_of_features({0.5, 0, 0.5}, {0, 0, 1});
  for (const auto& options : {options_of(0.8, RatioRule::Lowe), options_of(1, RatioRule::Lowe),
                              options_of(0.5, RatioRule::Literal), options_of(0, RatioRule::Literal)}) {
    const GroupingResult result = group_by_nearest_neighbor_ratio(matches, options);
    EXPECT_THAT(result.selected, ElementsAre(2));
    EXPECT_THAT(result.scores, ElementsAre(0, 0, 0.5));
  }
}

TEST(NearestNeighborRatio, LiteralReadsThePrintedInequality) {
  // s = 0.75, 0.8, 0.85: s >= 0.8 keeps the last two, d1/d2 <= 0.8 all.
  const CorrespondenceSet matches = table_of_features({5, 4, 3}, {20, 20, 20});
  EXPECT_THAT(group_by_nearest_neighbor_ratio(matches, options_of(0.8, RatioRule::Literal)).selected,
              ElementsAre(1, 2));
  EXPECT_THAT(group_by_nearest_neighbor_ratio(matches).selected, ElementsAre(0, 1, 2));
}

TEST(NearestNeighborRatio, ThresholdIsAnOption) {
  const CorrespondenceSet matches = table_of_features({0, 1, 2, 3, 4}, {4, 4, 4, 4, 4});
  EXPECT_THAT(group_by_nearest_neighbor_ratio(matches, options_of(0, RatioRule::Lowe)).selected, ElementsAre(0));
  EXPECT_THAT(group_by_nearest_neighbor_ratio(matches, options_of(0.5, RatioRule::Lowe)).selected,
              ElementsAre(0, 1, 2));
  EXPECT_THAT(group_by_nearest_neighbor_ratio(matches, options_of(1, RatioRule::Lowe)).selected,
              ElementsAre(0, 1, 2, 3, 4));
  for (const double bad : {-0.1, 1.1, std::nan("")})
    EXPECT_THAT(refusal_of([&] { group_by_nearest_neighbor_ratio(matches, options_of(bad, RatioRule::Lowe)); }),
                HasSubstr("threshold"));
}

TEST(NearestNeighborRatio, NothingDistinctiveGivesNothing) {
  EXPECT_THAT(group_by_nearest_neighbor_ratio(table_of_features({1, 1, 1}, {1, 1, 1})).selected, IsEmpty());
}

TEST(NearestNeighborRatio, AbsentColumnsAreNamed) {
  CorrespondenceSet matches = table_of_features({1, 1}, {2, 2});
  matches.second_feature_distance.resize(0);
  EXPECT_THAT(refusal_of([&] { group_by_nearest_neighbor_ratio(matches); }),
              HasSubstr("column second_feature_distance"));
  matches = table_of_features({1, 1}, {2, 2});
  matches.feature_distance.resize(0);
  const std::string refusal = refusal_of([&] { group_by_nearest_neighbor_ratio(matches); });
  EXPECT_THAT(refusal, HasSubstr("nnsr"));
  EXPECT_THAT(refusal, HasSubstr("column feature_distance"));
}

TEST(NearestNeighborRatio, ScoresAreFiniteWhereTheRatioIsNot) {
  const GroupingResult found = group_by_nearest_neighbor_ratio(table_of_features({0.5, 0.1}, {1e-310, 0.5}));
  EXPECT_EQ(found.scores[0], std::numeric_limits<double>::lowest());
  EXPECT_THAT(found.selected, ElementsAre(1));
}

}  // namespace
}  // namespace corral
