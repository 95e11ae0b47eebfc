// SPDX-License-Identifier: MIT
#include "grouping/search_of_inliers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/reference/groupers.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::column_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;

/// Points on a line, identity frames (T(c) moves by p' - p), and d1/d2 = 0.5 everywhere.
CorrespondenceSet table(const std::vector<double>& source, const std::vector<double>& target) {
  CorrespondenceSet matches = testing::table_on_line(source, target);
  testing::set_identity_frames(matches);
  matches.feature_distance = Eigen::VectorXd::Constant(matches.size(), 0.5);
  matches.second_feature_distance = Eigen::VectorXd::Constant(matches.size(), 1.0);
  return matches;
}

SearchOfInliersOptions options_of(VotingForm form, int voters = 250) {
  SearchOfInliersOptions options;
  options.form = form;
  options.voters = voters;
  return options;
}

// Rows 0 .. 3 stay where they are; r of row 4 to them is 0.4, 0.33, 0.25, 0.14.
CorrespondenceSet four_and_a_stray() { return table({0, 10, 20, 30, 40}, {0, 10, 20, 30, 100}); }

TEST(SearchOfInliers, CountsBothStages) {
  // Each of rows 0 .. 3 has 4 local voters, 3 of them agreeing, and as many global ones: 6 / 8.
  const GroupingResult result = group_by_search_of_inliers(four_and_a_stray());
  EXPECT_THAT(result.scores, ElementsAre(0.75, 0.75, 0.75, 0.75, 0));
  EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
  EXPECT_FALSE(result.target_from_source.has_value());
}

TEST(SearchOfInliers, SimilarityLimitIsExcludedButIncludedInCovis) {
  // r(0,1) = 9/10; row 2 agrees with no other. Equal scores are all kept.
  const CorrespondenceSet matches = table({0, 9, 100}, {0, 10, 300});
  const GroupingResult paper = group_by_search_of_inliers(matches);
  EXPECT_THAT(paper.scores, ElementsAre(0, 0, 0));
  EXPECT_THAT(paper.selected, ElementsAre(0, 1, 2));
  const GroupingResult covis = group_by_search_of_inliers(matches, options_of(VotingForm::Covis));
  EXPECT_THAT(covis.scores, ElementsAre(0.5, 0.5, 0));
  EXPECT_THAT(covis.selected, ElementsAre(0, 1));
}

TEST(SearchOfInliers, ResidualLimitIsExcluded) {
  // r(0,1) = 100/105 > 0.9. |T(0) p_1 - p'_1| = 5: a local vote but no global one.
  EXPECT_THAT(group_by_search_of_inliers(table({0, 100, 900}, {0, 105, 9000})).scores, ElementsAre(0.25, 0.25, 0));
  EXPECT_THAT(group_by_search_of_inliers(table({0, 100, 900}, {0, 104.5, 9000})).scores, ElementsAre(0.5, 0.5, 0));
  CorrespondenceSet coarse = table({0, 100, 900}, {0, 105, 9000});
  coarse.resolution = 2;  // tolerance 10
  EXPECT_THAT(group_by_search_of_inliers(coarse).scores, ElementsAre(0.5, 0.5, 0));
}

TEST(SearchOfInliers, LocalVotersPassTheRatioTest) {
  // Row 1 sits on the limit 0.8: it passes, except in the covis form. Row 2 is beyond it.
  CorrespondenceSet matches = table({0, 10, 20}, {0, 10, 20});
  matches.feature_distance = column_of({2, 4, 4.5});
  matches.second_feature_distance = column_of({5, 5, 5});
  matches.target_points(2, 0) = 90;  // agrees with no other
  // c = 0: local 1 of {1}, global 1 of {1,2}. c = 1: local 1 of {0}, global 1 of {0,2}. c = 2: 0 of {0,1}, 0 of {0,1}.
  EXPECT_THAT(group_by_search_of_inliers(matches).scores, ElementsAre(2.0 / 3, 2.0 / 3, 0));
  // covis, c = 0: no local voter, global 1 of 2. c = 1: as before.
  EXPECT_THAT(group_by_search_of_inliers(matches, options_of(VotingForm::Covis)).scores, ElementsAre(0.5, 2.0 / 3, 0));
}

TEST(SearchOfInliers, LocalVotersAreTheNearestInTheSource) {
  // kappa = 1; only rows 0 and 1 are correct. Row 2 is the best match by ratio and agrees with no other.
  CorrespondenceSet matches = table({0, 10, 25, 200}, {0, 10, 500, 9000});
  matches.feature_distance(2) = 0.1;
  // Nearest of 0: 1 (agrees). Of 1: 0 (agrees). Of 2: 1. Of 3: 2. Global voter 2 for all but itself.
  EXPECT_THAT(group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 1)).scores,
              ElementsAre(0.5, 0.5, 0, 0));
  matches.feature_distance(0) =
      0.95;  // the nearest of row 1 fails the ratio test: the next nearest is not asked instead
  EXPECT_THAT(group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 1)).scores, ElementsAre(0.5, 0, 0, 0));
}

TEST(SearchOfInliers, TieInDistanceGoesToTheLowerRow) {
  // Rows 0 and 2 are both 10 from row 1; row 0 agrees with it, row 2 does not. Global voter: row 3, agrees with no other.
  CorrespondenceSet matches = table({0, 10, 20, 200}, {0, 10, 500, 9000});
  matches.feature_distance(3) = 0.1;
  EXPECT_EQ(group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 1)).scores[1], 0.5);
  matches = table({20, 10, 0, 200}, {500, 10, 0, 9000});
  matches.feature_distance(3) = 0.1;
  EXPECT_EQ(group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 1)).scores[1], 0);
}

TEST(SearchOfInliers, GlobalVotersAreTheMostDistinctive) {
  // kappa = 2. The best by ratio are row 4 (the stray) and, of equals, the lowest: row 0.
  CorrespondenceSet matches = four_and_a_stray();
  matches.feature_distance(4) = 0.1;
  // c = 0: local {1,2}: 2, global {4}: 0. c = 1: {0,2}: 2, {0,4}: 1. c = 2: {1,3}: 2, 1. c = 3: {2,4}: 1, 1.
  // c = 4: {2,3}: 0, {0}: 0.
  const GroupingResult paper = group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 2));
  EXPECT_THAT(paper.scores, ElementsAre(2.0 / 3, 0.75, 0.75, 0.5, 0));
  // covis: local scores 1, 1, 1, 1/2, 0 name rows 0 and 1. c = 0: {1}: 1. c = 1: {0}: 1. c = 2, 3: {0,1}: 2. c = 4: 0.
  const GroupingResult covis = group_by_search_of_inliers(matches, options_of(VotingForm::Covis, 2));
  EXPECT_THAT(covis.scores, ElementsAre(1, 1, 1, 0.75, 0));
}

TEST(SearchOfInliers, InvalidFrameGetsNoGlobalVotesButIsStillAsked) {
  CorrespondenceSet matches = four_and_a_stray();
  matches.source_frames[0] *= 2;  // the product L'^T L is the identity all the same
  matches.target_frames[0] /= 2;
  matches.target_frames[2].setZero();
  // Rows 0 and 2: local 3 of 4, global 0 of 4. As voters they count as before.
  EXPECT_THAT(group_by_search_of_inliers(matches).scores, ElementsAre(0.375, 0.75, 0.375, 0.75, 0));
}

TEST(SearchOfInliers, WithoutDistinctiveMatchesOnlyTheGlobalStageVotes) {
  CorrespondenceSet matches = four_and_a_stray();
  matches.second_feature_distance.setZero();
  EXPECT_THAT(group_by_search_of_inliers(matches).scores, ElementsAre(0.75, 0.75, 0.75, 0.75, 0));
  // kappa = 1: all ratios are 0, so row 0 is the global voter, and it has no voter at all itself.
  EXPECT_THAT(group_by_search_of_inliers(matches, options_of(VotingForm::Paper, 1)).scores, ElementsAre(0, 1, 1, 1, 0));
}

TEST(SearchOfInliers, PoseIsTheFullMotionOrTheRotationAlone) {
  // Everything moved by 50: T(c) as a rotation leaves each voter 50 from its target.
  const CorrespondenceSet moved = table({0, 10, 20, 30, 40}, {50, 60, 70, 80, 150});
  EXPECT_THAT(group_by_search_of_inliers(moved).scores, ElementsAre(0.75, 0.75, 0.75, 0.75, 0));
  const auto rotation = options_of(VotingForm::Rotation);
  EXPECT_THAT(group_by_search_of_inliers(moved, rotation).scores, ElementsAre(0.375, 0.375, 0.375, 0.375, 0));
  EXPECT_THAT(group_by_search_of_inliers(four_and_a_stray(), rotation).scores, ElementsAre(0.75, 0.75, 0.75, 0.75, 0));
}

TEST(SearchOfInliers, PoseComesFromBothFrames) {
  // A quarter turn about z: (x, 0, 0) goes to (0, x, 0). R = L'^T L must be that turn, whatever L is.
  CorrespondenceSet matches = four_and_a_stray();
  Eigen::Matrix3d turn, frame;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  frame << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  matches.target_points = (matches.target_points * turn.transpose()).eval();
  for (std::size_t row = 0; row < 5; ++row) {
    matches.source_frames[row] = frame;
    matches.target_frames[row] = frame * turn.transpose();
  }
  EXPECT_THAT(group_by_search_of_inliers(matches).scores, ElementsAre(0.75, 0.75, 0.75, 0.75, 0));
}

TEST(SearchOfInliers, OneOrTwoRowsAreReturnedAsTheyAre) {
  for (const VotingForm form : {VotingForm::Paper, VotingForm::Covis, VotingForm::Rotation}) {
    const GroupingResult one = group_by_search_of_inliers(table({1}, {5}), options_of(form));
    const GroupingResult two = group_by_search_of_inliers(table({1, 2}, {5, 900}), options_of(form));
    EXPECT_THAT(one.selected, ElementsAre(0));
    EXPECT_THAT(two.selected, ElementsAre(0, 1));
    EXPECT_THAT(two.scores, IsEmpty());
  }
}

TEST(SearchOfInliers, OtsuRuleIsAnOption) {
  // Scores 1/2, 1/2, 0: covis has 2 bins, the threshold 0 / 1 and keeps the two above it.
  SearchOfInliersOptions options;
  options.otsu = OtsuRule::Covis;
  EXPECT_THAT(group_by_search_of_inliers(table({0, 100, 900}, {0, 104.5, 9000}), options).selected, ElementsAre(0, 1));
}

TEST(SearchOfInliers, AnyNumberOfVotersWorks) {
  const auto most = options_of(VotingForm::Paper, std::numeric_limits<int>::max());
  EXPECT_THAT(group_by_search_of_inliers(four_and_a_stray(), most).selected, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(refusal_of([] { group_by_search_of_inliers(table({0}, {0}), options_of(VotingForm::Paper, 0)); }),
              HasSubstr("voters"));
}

TEST(SearchOfInliers, AbsentColumnsAreNamed) {
  const auto refusal_without = [](auto&& remove) {
    CorrespondenceSet matches = four_and_a_stray();
    remove(matches);
    return refusal_of([&] { group_by_search_of_inliers(matches); });
  };
  EXPECT_THAT(refusal_without([](auto& t) { t.source_frames.clear(); }), HasSubstr("column source_frames"));
  EXPECT_THAT(refusal_without([](auto& t) { t.target_frames.clear(); }), HasSubstr("column target_frames"));
  EXPECT_THAT(refusal_without([](auto& t) { t.feature_distance.resize(0); }), HasSubstr("column feature_distance"));
  EXPECT_THAT(refusal_without([](auto& t) { t.second_feature_distance.resize(0); }),
              HasSubstr("column second_feature_distance"));
}

TEST(SearchOfInliers, NeighboursAreThoseOfDoublesWhereFloatsCannotTell) {
  // A lattice: many neighbours are equally far but for the last bits of a double.
  CorrespondenceSet matches = testing::synthetic(216, 0.6, 1).matches;
  for (int row = 0; row < matches.size(); ++row) {
    const Eigen::RowVector3d place(row % 6, row / 6 % 6, row / 36);
    matches.source_points.row(row) = 12.3 * Eigen::RowVector3d::Ones() + 0.37 * place;
    matches.target_points.row(row) = (row % 5 == 0 ? 0.5 : 1.0) * matches.source_points.row(row);
  }
  matches.source_points(215, 0) = 5000;  // and far away another match, which makes floats coarse
  for (const int voters : {3, 7, 20, 60}) {
    SearchOfInliersOptions options;
    options.voters = voters;
    const reference::Selection expected = reference::search_of_inliers(matches, options);
    const GroupingResult found = group_by_search_of_inliers(matches, options);
    EXPECT_EQ(found.selected, expected.rows) << voters;
    EXPECT_EQ(found.scores, expected.scores) << voters;
  }
}

}  // namespace
}  // namespace corral
