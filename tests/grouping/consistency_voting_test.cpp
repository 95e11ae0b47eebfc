// SPDX-License-Identifier: MIT
#include "grouping/consistency_voting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/reference/consistency_voting.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pointwise;

Eigen::Matrix3d turn_about_z(double deg) {
  return Eigen::AngleAxisd(deg * std::acos(-1.0) / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Row 0 is the one voter; row 1 is 10 longer, the frame of row 2 is turned by 20 degrees, row 3 agrees.
CorrespondenceSet four_rows() {
  CorrespondenceSet matches = testing::table_of_points({{0, 0, 0}, {40, 0, 0}, {0, 30, 0}, {0, 0, 20}},
                                                       {{0, 0, 0}, {50, 0, 0}, {0, 30, 0}, {0, 0, 20}});
  testing::set_identity_frames(matches);
  matches.target_frames[2] = turn_about_z(20);
  matches.feature_distance = testing::column_of({0.1, 0.5, 0.5, 0.5});
  matches.second_feature_distance = testing::column_of({1, 1, 1, 1});
  return matches;
}

ConsistencyVotingOptions with_voters(int voters) {
  ConsistencyVotingOptions options;
  options.voters = voters;
  return options;
}

TEST(ConsistencyVoting, ScoresAreThoseWorkedOutByHand) {
  const GroupingResult result = group_by_consistency_voting(four_rows(), with_voters(1));
  EXPECT_THAT(result.scores,
              Pointwise(DoubleNear(1e-12), {0.0, std::exp(-1.0), std::exp(-4.0), 1.0}));  // none votes for itself
  EXPECT_THAT(result.selected, ElementsAre(3));
}

TEST(ConsistencyVoting, AMatchWithoutAFrameCountsAsTheOptionSays) {
  CorrespondenceSet matches = four_rows();
  matches.target_frames[1].setZero();
  ConsistencyVotingOptions options = with_voters(1);
  EXPECT_EQ(group_by_consistency_voting(matches, options).scores[1], 0);
  options.frames = FrameNeed::Optional;
  EXPECT_NEAR(group_by_consistency_voting(matches, options).scores[1], std::exp(-1.0), 1e-12);
  matches.source_frames.clear();
  EXPECT_NEAR(group_by_consistency_voting(matches, options).scores[2], 1, 1e-12);
  options.frames = FrameNeed::Required;
  EXPECT_THAT(testing::refusal_of([&] { group_by_consistency_voting(matches, options); }), HasSubstr("source_frames"));
}

TEST(ConsistencyVoting, TurningTheTargetWithItsFramesChangesNothing) {
  const CorrespondenceSet matches = testing::synthetic(100, 0.3, 8).matches;
  RigidTransform turn;
  turn.rotation = turn_about_z(77);
  const GroupingResult found = group_by_consistency_voting(testing::with_moved_target(matches, turn)),
                       expected = group_by_consistency_voting(matches);
  EXPECT_EQ(found.selected, expected.selected);
  EXPECT_THAT(found.scores, Pointwise(DoubleNear(1e-9), expected.scores));
}

TEST(ConsistencyVoting, TwoMatchesVoteAlikeForEachOther) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const GroupingResult found = group_by_consistency_voting(testing::synthetic(2, 1, seed).matches);
    ASSERT_EQ(found.scores.size(), 2u);
    EXPECT_EQ(found.scores[0], found.scores[1]) << "to the last bit";
  }
}

TEST(ConsistencyVoting, AnswerIsThatOfTheReference) {
  for (const FrameNeed frames : {FrameNeed::Required, FrameNeed::Optional})
    for (const int rows : {1, 2, 21, 100, 500})
      for (const double ratio : {0.05, 0.5}) {
        ConsistencyVotingOptions options;
        options.frames = frames;
        const CorrespondenceSet matches = testing::synthetic(rows, ratio, 9).matches;
        const GroupingResult found = group_by_consistency_voting(matches, options);
        const reference::Selection expected = reference::consistency_voting(matches, options);
        EXPECT_EQ(found.selected, expected.rows) << rows;
        EXPECT_THAT(found.scores, Pointwise(DoubleNear(1e-9), expected.scores));
      }
}

}  // namespace
}  // namespace corral
