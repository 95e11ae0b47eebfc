// SPDX-License-Identifier: MIT
#include "apps/study/time_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/synthetic.h"

namespace corral {
namespace {

TEST(DrawRows, KeepsRowsWholeAndInOrder) {
  CorrespondenceSet matches = make_synthetic_problem({}).matches;
  const int size = matches.size();
  ASSERT_GT(size, 20);
  for (int row = 0; row < size; ++row) matches.source_points(row, 0) = row;
  const auto count = static_cast<std::size_t>(size);
  matches.source_keypoints.resize(count), matches.target_keypoints.resize(count);
  for (int row = 0; row < size; ++row) matches.target_keypoints[static_cast<std::size_t>(row)] = row;
  const CorrespondenceSet drawn = draw_rows(matches, 20, 3);
  drawn.validate();
  ASSERT_EQ(drawn.size(), 20);
  for (int i = 0; i < 20; ++i) {
    const int row = drawn.target_keypoints[static_cast<std::size_t>(i)];
    EXPECT_EQ(drawn.source_points(i, 0), row);
    EXPECT_EQ(drawn.target_points.row(i), matches.target_points.row(row));
    EXPECT_EQ(drawn.feature_distance(i), matches.feature_distance(row));
    EXPECT_EQ(drawn.source_frames[static_cast<std::size_t>(i)], matches.source_frames[static_cast<std::size_t>(row)]);
    if (i > 0) {
      EXPECT_GT(row, drawn.target_keypoints[static_cast<std::size_t>(i - 1)]);
    }
  }
  EXPECT_EQ(draw_rows(matches, 20, 3).source_points, drawn.source_points);
  EXPECT_NE(draw_rows(matches, 20, 4).source_points, drawn.source_points);
  EXPECT_EQ(draw_rows(matches, size, 4).source_points, matches.source_points);
}

}  // namespace
}  // namespace corral
