// SPDX-License-Identifier: MIT
#include "kernel/correspondence_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::full_table;
using ::testing::HasSubstr;
using testing::refusal_of;

/// What validate() says of a good table after a change.
template <class Change>
std::string verdict(Change&& change) {
  CorrespondenceSet matches = full_table(5);
  change(matches);
  return refusal_of([&] { matches.validate(); });
}

template <class Change>
void expect_blames(const std::string& column, Change&& change) {
  EXPECT_THAT(verdict(change), HasSubstr(column));
}

TEST(CorrespondenceSet, SelectedRowsKeepAllTheirColumns) {
  const CorrespondenceSet matches = full_table(5);
  const Indices rows = {4, 0, 4};
  const CorrespondenceSet chosen = select_rows(matches, rows);
  ASSERT_EQ(chosen.size(), 3);
  EXPECT_EQ(refusal_of([&] { chosen.validate(); }), "");
  for (int i = 0; i < 3; ++i) {
    const auto to = static_cast<std::size_t>(i), from = static_cast<std::size_t>(rows[to]);
    EXPECT_EQ(chosen.source_points.row(i), matches.source_points.row(rows[to]));
    EXPECT_EQ(chosen.target_points.row(i), matches.target_points.row(rows[to]));
    EXPECT_EQ(chosen.source_frames[to], matches.source_frames[from]);
    EXPECT_EQ(chosen.target_frames[to], matches.target_frames[from]);
    EXPECT_EQ(chosen.source_keypoints[to], matches.source_keypoints[from]);
    EXPECT_EQ(chosen.target_keypoints[to], matches.target_keypoints[from]);
    EXPECT_EQ(chosen.feature_distance(i), matches.feature_distance(rows[to]));
    EXPECT_EQ(chosen.second_feature_distance(i), matches.second_feature_distance(rows[to]));
  }
  EXPECT_EQ(chosen.resolution, matches.resolution);
  EXPECT_EQ(chosen.source_centroid, matches.source_centroid);
}

TEST(CorrespondenceSet, SelectedRowsLackWhatTheTableLacks) {
  CorrespondenceSet matches;
  matches.source_points = matches.target_points = Points::Zero(2, 3);
  const CorrespondenceSet chosen = select_rows(matches, {1});
  EXPECT_EQ(chosen.size(), 1);
  EXPECT_TRUE(chosen.source_frames.empty() && chosen.target_keypoints.empty() && chosen.feature_distance.size() == 0);
  EXPECT_EQ(select_rows(matches, {}).size(), 0);
  EXPECT_THROW(select_rows(matches, {2}), InvalidInput);
  EXPECT_THROW(select_rows(matches, {-1}), InvalidInput);
}

TEST(CorrespondenceSet, GoodTablesPass) {
  EXPECT_EQ(verdict([](auto&) {}), "");
  EXPECT_EQ(refusal_of([] { CorrespondenceSet{Points(0, 3), Points(0, 3), {}, {}, {}, {}, {}, {}, 1, {}}.validate(); }),
            "");
  // Only the points have to be there.
  EXPECT_EQ(verdict([](auto& matches) {
              matches.source_frames.clear();
              matches.target_frames.clear();
              matches.source_keypoints.clear();
              matches.target_keypoints.clear();
              matches.feature_distance.resize(0);
              matches.second_feature_distance.resize(0);
              matches.source_centroid.reset();
            }),
            "");
  // A keypoint without a frame carries the zero matrix.
  EXPECT_EQ(verdict([](auto& matches) { matches.source_frames[2].setZero(); }), "");
}

TEST(CorrespondenceSet, RaggedColumnsAreNamed) {
  expect_blames("target_points", [](auto& matches) { matches.target_points.conservativeResize(4, 3); });
  expect_blames("target_points", [](auto& matches) { matches.target_points.resize(0, 3); });
  for (const std::size_t rows : {4u, 6u}) {
    const auto count = static_cast<Eigen::Index>(rows);
    expect_blames("source_frames",
                  [&](auto& matches) { matches.source_frames.resize(rows, Eigen::Matrix3d::Identity()); });
    expect_blames("target_frames",
                  [&](auto& matches) { matches.target_frames.resize(rows, Eigen::Matrix3d::Identity()); });
    expect_blames("source_keypoints", [&](auto& matches) { matches.source_keypoints.resize(rows, 0); });
    expect_blames("target_keypoints", [&](auto& matches) { matches.target_keypoints.resize(rows, 0); });
    expect_blames("feature_distance", [&](auto& matches) { matches.feature_distance.setZero(count); });
    expect_blames("second_feature_distance", [&](auto& matches) { matches.second_feature_distance.setZero(count); });
  }
}

TEST(CorrespondenceSet, ValuesThatAreNotFiniteAreNamed) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    expect_blames("source_points", [&](auto& matches) { matches.source_points(4, 2) = bad; });
    expect_blames("target_points", [&](auto& matches) { matches.target_points(0, 0) = bad; });
    expect_blames("source_frames", [&](auto& matches) { matches.source_frames[3](1, 2) = bad; });
    expect_blames("target_frames", [&](auto& matches) { matches.target_frames[4](2, 2) = bad; });
    expect_blames("feature_distance", [&](auto& matches) { matches.feature_distance(4) = bad; });
    expect_blames("second_feature_distance", [&](auto& matches) { matches.second_feature_distance(0) = bad; });
    expect_blames("source_centroid", [&](auto& matches) { matches.source_centroid = Eigen::Vector3d(0, bad, 0); });
    expect_blames("resolution", [&](auto& matches) { matches.resolution = bad; });
  }
}

TEST(CorrespondenceSet, ResolutionMustBePositive) {
  for (const double bad : {0.0, -0.0, -1.0})
    expect_blames("resolution", [&](auto& matches) { matches.resolution = bad; });
}

TEST(CorrespondenceSet, CentroidIsTheStoredOneOrTheMean) {
  CorrespondenceSet matches = testing::table_of_points({{0, 0, 0}, {2, 4, 6}}, {{0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(matches.source_centroid_or_mean(), Eigen::Vector3d(1, 2, 3));
  matches.source_centroid = Eigen::Vector3d(7, 8, 9);
  EXPECT_EQ(matches.source_centroid_or_mean(), Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(testing::table_of_points({}, {}).source_centroid_or_mean(), Eigen::Vector3d(0, 0, 0));
}

TEST(RequireColumns, NamesTheCallerAndTheColumn) {
  const auto missing = [](CorrespondenceSet matches, Column column) {
    return refusal_of([&] { require_columns(matches, "someone", {column}); });
  };
  for (const Column column :
       {Column::SourceFrames, Column::TargetFrames, Column::FeatureDistance, Column::SecondFeatureDistance})
    EXPECT_EQ(missing(full_table(5), column), "");
  const CorrespondenceSet bare = testing::table_of_points({{1, 2, 3}}, {{4, 5, 6}});
  EXPECT_THAT(missing(bare, Column::SourceFrames), HasSubstr("source_frames"));
  EXPECT_THAT(missing(bare, Column::TargetFrames), HasSubstr("target_frames"));
  EXPECT_THAT(missing(bare, Column::FeatureDistance), HasSubstr("column feature_distance is absent"));
  EXPECT_THAT(missing(bare, Column::SecondFeatureDistance), HasSubstr("second_feature_distance"));
  EXPECT_THAT(missing(bare, Column::SourceFrames), HasSubstr("someone"));
  EXPECT_EQ(refusal_of([&] { require_columns(bare, "someone", {}); }), "");
  // An empty table lacks nothing.
  EXPECT_EQ(missing(testing::table_of_points({}, {}), Column::SourceFrames), "");
}

TEST(RequireColumns, ValidatesFirst) {
  CorrespondenceSet ragged = full_table(5);
  ragged.target_frames.pop_back();
  EXPECT_THAT(refusal_of([&] { require_columns(ragged, "someone", {Column::FeatureDistance}); }),
              HasSubstr("target_frames"));
}

TEST(IsValidFrame, TellsFramesFromTheRest) {
  RandomStream random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const LocalReferenceFrame frame = random.rotation();
    EXPECT_TRUE(is_valid_frame(frame));
    EXPECT_FALSE(is_valid_frame(-frame));
    LocalReferenceFrame bent = frame;
    bent.row(0) = (bent.row(0) + 1e-3 * bent.row(1)).normalized();
    EXPECT_FALSE(is_valid_frame(bent));
    EXPECT_TRUE(is_valid_frame(frame * (1 + 4e-5)));
    EXPECT_FALSE(is_valid_frame(frame * (1 + 6e-5)));
    bent = frame;
    bent(trial % 3, trial / 3 % 3) = std::nan("");
    EXPECT_FALSE(is_valid_frame(bent));
  }
  EXPECT_FALSE(is_valid_frame(Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(is_valid_frame(Eigen::Matrix3d::Constant(HUGE_VAL)));
}

}  // namespace
}  // namespace corral
