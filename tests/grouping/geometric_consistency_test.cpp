// SPDX-License-Identifier: MIT
#include "grouping/geometric_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::column_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::table_on_line;

GeometricConsistencyOptions clique() {
  GeometricConsistencyOptions options;
  options.cluster = ClusterRule::Clique;
  return options;
}

TEST(GeometricConsistency, LimitIsExcluded) {
  // d(0,1) = |10 - 13| = 3, d(1,2) = |10 - 7| = 3, d(0,2) = 0; tolerance 3.
  const CorrespondenceSet matches = table_on_line({0, 10, 20}, {0, 13, 20});
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 2));
  GeometricConsistencyOptions options;
  options.tolerance_pr = 3.001;
  EXPECT_THAT(group_by_geometric_consistency(matches, options).selected, ElementsAre(0, 1, 2));
}

TEST(GeometricConsistency, ToleranceIsInPr) {
  CorrespondenceSet matches = table_on_line({0, 10, 20}, {0, 13, 20});
  matches.resolution = 2;  // tolerance 6
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 1, 2));
  matches.resolution = 0.5;
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 2));
}

TEST(GeometricConsistency, StarNeedsAgreementWithTheSeedOnly) {
  // d(0,1) = 2, d(1,2) = 2, d(0,2) = 4: only row 1 agrees with both others.
  const CorrespondenceSet matches = table_on_line({0, 100, 200}, {0, 102, 204});
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 1, 2));
}

TEST(GeometricConsistency, TieGoesToTheLowestSeed) {
  // Pairs {1,3} and {2,4} agree, d = 0; everything else lies thousands apart in the target.
  const CorrespondenceSet matches = table_on_line({0, 100, 200, 130, 210}, {0, 9100, 3200, 9130, 3210});
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(1, 3));
}

TEST(GeometricConsistency, MirroredMatchesAgreeToo) {
  // Distances cannot tell a reflection from a motion.
  const CorrespondenceSet matches = table_on_line({0, 10, 30, 70}, {0, -10, -30, -70});
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 1, 2, 3));
}

TEST(GeometricConsistency, LonelyMatchIsItsOwnCluster) {
  EXPECT_THAT(group_by_geometric_consistency(table_on_line({5}, {7})).selected, ElementsAre(0));
  EXPECT_THAT(group_by_geometric_consistency(table_on_line({0, 10, 20}, {0, 50, 500})).selected, ElementsAre(0));
}

TEST(GeometricConsistency, CoincidingRowsAgree) {
  EXPECT_THAT(group_by_geometric_consistency(table_on_line({1, 1, 1, 1}, {2, 2, 2, 9})).selected, ElementsAre(0, 1, 2));
}

TEST(GeometricConsistency, AnswersWithRowsOnly) {
  const GroupingResult result = group_by_geometric_consistency(table_on_line({0, 10, 20}, {0, 10, 20}));
  EXPECT_THAT(result.scores, IsEmpty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

TEST(GeometricConsistency, ToleranceMustBePositive) {
  for (const double bad : {0.0, -3.0, std::nan("")}) {
    GeometricConsistencyOptions options;
    options.tolerance_pr = bad;
    EXPECT_THAT(refusal_of([&] { group_by_geometric_consistency(table_on_line({0}, {0}), options); }),
                HasSubstr("tolerance_pr"));
  }
}

// Rows 0 .. 3 agree with each other; row 4 agrees with row 0 alone: d(0,4) = 0, d(1,4) = |60 - 40|, and so on.
CorrespondenceSet four_and_a_stray() { return table_on_line({0, 10, 20, 30, -50}, {0, 10, 20, 30, 50}); }

TEST(GeometricConsistencyClique, NewMemberAgreesWithAll) {
  CorrespondenceSet matches = four_and_a_stray();
  EXPECT_THAT(group_by_geometric_consistency(matches).selected, ElementsAre(0, 1, 2, 3, 4));  // star of row 0
  matches.feature_distance = column_of({0.1, 0.2, 0.3, 0.4, 0.5});
  EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, ElementsAre(0, 1, 2, 3));
}

TEST(GeometricConsistencyClique, SmallClusterLeavesItsMembersFree) {
  // The stray is asked first: it takes row 0 and stops at 2. Row 0 meets the stray first: 2 again. Row 1 takes 0, 2, 3.
  CorrespondenceSet matches = four_and_a_stray();
  matches.feature_distance = column_of({0.1, 0.2, 0.3, 0.4, 0.0});
  EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, ElementsAre(0, 1, 2, 3));
}

TEST(GeometricConsistencyClique, ThreeAreTooFew) {
  CorrespondenceSet matches = table_on_line({0, 10, 20, 500}, {0, 10, 20, 9000});
  matches.feature_distance = column_of({0, 0, 0, 0});
  EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, IsEmpty());
}

TEST(GeometricConsistencyClique, LargestWinsAndFirstFoundWinsATie) {
  // Two cliques of four, {0,1,2,3} and {4,5,6,7}; a ninth row joins the second or none.
  const std::vector<double> source = {0, 10, 20, 30, 100, 110, 120, 130, 140};
  const std::vector<double> joined = {0, 10, 20, 30, 9100, 9110, 9120, 9130, 9140};
  std::vector<double> lonely = joined;
  lonely[8] = 50000;
  for (const double first_distance : {0.1, 0.9}) {
    std::vector<double> distances(9, 0.5);
    distances[0] = first_distance;  // with 0.9, row 1 is asked first, still before row 4
    CorrespondenceSet matches = table_on_line(source, lonely);
    matches.feature_distance = column_of(distances);
    EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, ElementsAre(0, 1, 2, 3));
    matches.target_points = table_on_line(source, joined).target_points;
    EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, ElementsAre(4, 5, 6, 7, 8));
    distances[4] = 0;  // the second clique is found first
    matches.feature_distance = column_of(distances);
    matches.target_points = table_on_line(source, lonely).target_points;
    EXPECT_THAT(group_by_geometric_consistency(matches, clique()).selected, ElementsAre(4, 5, 6, 7));
  }
}

TEST(GeometricConsistencyClique, NeedsFeatureDistances) {
  const CorrespondenceSet matches = four_and_a_stray();
  const std::string refusal = refusal_of([&] { group_by_geometric_consistency(matches, clique()); });
  EXPECT_THAT(refusal, HasSubstr("gc"));
  EXPECT_THAT(refusal, HasSubstr("column feature_distance"));
  EXPECT_NO_THROW(group_by_geometric_consistency(matches));
}

}  // namespace
}  // namespace corral
