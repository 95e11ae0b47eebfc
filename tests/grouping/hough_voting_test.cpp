// SPDX-License-Identifier: MIT
#include "grouping/hough_voting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::Row3;

/// Row i votes for votes[i]: source points and centroid at the origin, identity frames, so g_i = p'_i.
CorrespondenceSet table_of_votes(const std::vector<Row3>& votes) {
  CorrespondenceSet matches = testing::table_of_points(std::vector<Row3>(votes.size(), Row3{0, 0, 0}), votes);
  testing::set_identity_frames(matches);
  matches.source_centroid = Eigen::Vector3d::Zero();
  return matches;
}

CorrespondenceSet table_of_votes_on_line(const std::vector<double>& votes) {
  std::vector<Row3> rows;
  for (const double vote : votes) rows.push_back({vote, 0, 0});
  return table_of_votes(rows);
}

HoughVotingOptions pr5() {
  HoughVotingOptions options;
  options.cells = HoughCells::Pr5;
  return options;
}

TEST(HoughVoting, FullestCellAndItsTwoNeighbours) {
  // Box 0 .. 15, cells of 1: cell 7 holds 7.1 and 7.5; 6.9 and 8.2 are in its neighbours, 9.5 two cells away.
  const CorrespondenceSet matches = table_of_votes_on_line({0, 7.1, 9.5, 7.5, 8.2, 15, 6.9, 5.9});
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(1, 3, 4, 6));
}

TEST(HoughVoting, EdgeNeighboursAreLeftOut) {
  // Cells of 1 in x and y. Peak (7, 7); rows 4 .. 7 in (8,7), (6,7), (7,8), (8,8): the last shares an edge only.
  const CorrespondenceSet matches = table_of_votes({{0, 0, 0},
                                                    {15, 15, 0},
                                                    {7.5, 7.5, 0},
                                                    {7.4, 7.6, 0},
                                                    {8.5, 7.5, 0},
                                                    {6.5, 7.5, 0},
                                                    {7.5, 8.5, 0},
                                                    {8.5, 8.5, 0}});
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(2, 3, 4, 5, 6));
}

TEST(HoughVoting, NeighboursDoNotWrapAround) {
  // Peak (14, 7) on the border; (0, 8) is next to it only if rows of cells are joined end to end.
  const CorrespondenceSet matches =
      table_of_votes({{14.5, 7.5, 0}, {14.6, 7.6, 0}, {0.5, 8.5, 0}, {0, 0, 0}, {15, 15, 0}, {0.5, 7.5, 0}});
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1));
}

TEST(HoughVoting, LargestVoteIsInTheLastCell) {
  EXPECT_THAT(group_by_hough_voting(table_of_votes_on_line({0, 14.2, 15, 3})).selected, ElementsAre(1, 2));
}

TEST(HoughVoting, TieGoesToTheLowestCellByXThenYThenZ) {
  EXPECT_THAT(group_by_hough_voting(table_of_votes_on_line({15, 14.5, 0, 0.5, 8})).selected, ElementsAre(2, 3));
  // Cells (4, 10, 0) and (10, 4, 0) hold two votes each.
  const CorrespondenceSet matches =
      table_of_votes({{0, 0, 0}, {15, 15, 0}, {10.5, 4.5, 0}, {10.5, 4.5, 0}, {4.5, 10.5, 0}, {4.5, 10.5, 0}});
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(4, 5));
}

TEST(HoughVoting, BinsAreAnOption) {
  // 3 bins of 5: cell 1 holds 7.1, 7.5, 9.5 and both others are its neighbours.
  HoughVotingOptions options;
  options.bins = 3;
  const CorrespondenceSet matches = table_of_votes_on_line({0, 7.1, 9.5, 7.5, 15});
  EXPECT_THAT(group_by_hough_voting(matches, options).selected, ElementsAre(0, 1, 2, 3, 4));
  for (const int bad : {0, -1, 1001}) {
    options.bins = bad;
    EXPECT_THAT(refusal_of([&] { group_by_hough_voting(matches, options); }), HasSubstr("bins"));
  }
}

TEST(HoughVoting, VotesAtOnePlaceAreAllKept) {
  EXPECT_THAT(group_by_hough_voting(table_of_votes_on_line({3, 3, 3})).selected, ElementsAre(0, 1, 2));
  EXPECT_THAT(group_by_hough_voting(table_of_votes_on_line({3})).selected, ElementsAre(0));
}

TEST(HoughVoting, InvalidFrameHasNoVote) {
  CorrespondenceSet matches = table_of_votes_on_line({0, 7.1, 7.2, 7.5, 15, 900});
  matches.source_frames[1].setZero();
  matches.target_frames[2] *= 2;
  matches.target_frames[5].col(0) *= -1;  // left-handed; its vote would stretch the box to 60 per cell
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0));  // three cells with one vote: the lowest
  for (auto& frame : matches.target_frames) frame.setZero();
  EXPECT_THAT(group_by_hough_voting(matches).selected, IsEmpty());
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, IsEmpty());
}

TEST(HoughVoting, FramesOfAMotionCarryTheCentroidToOnePlace) {
  // p' = R p + t and L' = L R^T for rows 0 .. 3: whatever L is, g = R (C - p) + p' = R C + t. Rows 4 and 5 are wrong.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  CorrespondenceSet matches = testing::table_of_points(
      {{0, 0, 0}, {10, 0, 0}, {0, 20, 0}, {0, 0, 30}, {5, 5, 5}, {6, 6, 6}}, std::vector<Row3>(6, Row3{0, 0, 0}));
  RigidTransform motion;
  motion.rotation = turn;
  motion.translation = Eigen::Vector3d(100, -20, 3);
  matches.target_points = motion.apply(matches.source_points);
  matches.target_points.row(4) += Eigen::RowVector3d(300, 200, -500);
  matches.target_points.row(5) -= Eigen::RowVector3d(300, 200, -500);
  for (int row = 0; row < 6; ++row) {
    const Eigen::Matrix3d frame = Eigen::AngleAxisd(row, Eigen::Vector3d::UnitY()).toRotationMatrix();
    matches.source_frames.push_back(frame);
    matches.target_frames.push_back(frame * turn.transpose());
  }
  matches.source_centroid = Eigen::Vector3d(-40, 7, 90);
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, ElementsAre(0, 1, 2, 3));
}

TEST(HoughVoting, CentroidDefaultsToTheMeanOfTheSourcePoints) {
  // Rows 0 and 1 do not turn and vote for C. Row 2 is half a turn about z and votes for -C + (2, 0, 0).
  CorrespondenceSet matches = table_of_votes({{6, 0, 0}, {-6, 0, 0}, {2, 0, 0}, {90, 0, 0}});
  matches.source_points = testing::points_of({{6, 0, 0}, {-6, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  matches.target_frames[2] = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  matches.source_centroid = Eigen::Vector3d(1, 0, 0);  // votes 1, 1, 1, 91
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1, 2));
  matches.source_centroid = Eigen::Vector3d(31, 0, 0);  // votes 31, 31, -29, 121
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1));
  matches.target_points(2, 0) = 62;
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1, 2));
  matches.source_centroid.reset();  // the mean is the origin: votes 0, 0, 62, 90
  EXPECT_THAT(group_by_hough_voting(matches).selected, ElementsAre(0, 1));
}

TEST(HoughVotingPr5, VotersOfTheHeaviestCube) {
  // Cubes of 5 from 0, centres 2.5, 7.5, ... Shares in the cube 10 .. 15 (centre 12.5): 10 gives 0.5, again 0.5, 12
  // gives 0.9, 14.9 gives 0.52, 17.5 and 7.5 nothing; 2.42 in all. Its neighbours get 2.1 and 1.48.
  const CorrespondenceSet matches = table_of_votes_on_line({0, 10, 10, 12, 14.9, 17.5, 7.5, 100});
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, ElementsAre(1, 2, 3, 4));
}

TEST(HoughVotingPr5, CubeIsInPr) {
  // Votes 0, 20, 24, 100 in cubes of 5: the two middle ones share the cube 20 .. 25 (weights 0.5 and 0.7).
  CorrespondenceSet matches = table_of_votes_on_line({0, 20, 24, 100});
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, ElementsAre(1, 2));
  matches.resolution = 0.1;  // cubes of 0.5: nobody shares a cube; the weights are 0.5, and the lowest cube wins
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, ElementsAre(0));
}

TEST(HoughVotingPr5, HugeExtentCostsNothing) {
  const CorrespondenceSet matches = table_of_votes_on_line({-1e15, 1, 2, 1e15});
  EXPECT_THAT(group_by_hough_voting(matches, pr5()).selected, ElementsAre(1, 2));
}

TEST(HoughVoting, AbsentColumnsAreNamed) {
  CorrespondenceSet matches = table_of_votes_on_line({0, 1});
  matches.target_frames.clear();
  EXPECT_THAT(refusal_of([&] { group_by_hough_voting(matches); }), HasSubstr("column target_frames"));
  matches.source_frames.clear();
  EXPECT_THAT(refusal_of([&] { group_by_hough_voting(matches); }), HasSubstr("column source_frames"));
}

// All votes meet in one point; what is left of the extent is rounding.
TEST(HoughVoting, AnExactCopyIsSelectedWhole) {
  SyntheticOptions options;
  options.inlier_ratio = 1;
  options.noise_pr = options.frame_noise_deg = 0;
  for (const double offset : {0.0, 1e7})
    for (const double resolution : {1e-3, 1.0}) {
      options.resolution = resolution;
      SyntheticProblem problem = make_synthetic_problem(options);
      problem.matches.target_points.array() += offset;
      EXPECT_EQ(group_by_hough_voting(problem.matches).selected.size(), 500U) << offset << " " << resolution;
    }
}

}  // namespace
}  // namespace corral
