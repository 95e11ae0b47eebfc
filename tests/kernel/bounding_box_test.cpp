// SPDX-License-Identifier: MIT
#include "kernel/bounding_box.h"

#include <gtest/gtest.h>

#include "tests/support/execution.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/columns.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

TEST(BoundingBox, HoldsThePointsAndNoMore) {
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    for (const int count : {1, 7, 8, 9, 100}) {
      const Points points = testing::uniform_points(count, static_cast<std::uint64_t>(count));
      const BoundingBox box = bounding_box(points);
      for (int axis = 0; axis < 3; ++axis) {
        const Extent extent = testing::reference_extent(points.col(axis).data(), count);
        EXPECT_EQ(box.low(axis), extent.low);
        EXPECT_EQ(box.high(axis), extent.high);
      }
      EXPECT_EQ(box.longest_side(), (box.high - box.low).maxCoeff());
    }
  }
}

TEST(BoundingBox, HasADiagonalAndAMiddle) {
  const BoundingBox box = bounding_box(points_of({{1, 2, 3}, {3, 5, 3}, {2, 3, 9}}));
  EXPECT_DOUBLE_EQ(box.diagonal(), 7);
  EXPECT_EQ(box.middle(), Eigen::RowVector3d(2, 3.5, 6));
  EXPECT_DOUBLE_EQ(bounding_box(points_of({{-1e7, 0, 0}, {1e7, 0, 0}})).diagonal(), 2e7);
  EXPECT_TRUE(bounding_box(points_of({{-1.7e308, 0, 0}, {1.7e308, 0, 0}})).middle().isZero(0));
}

TEST(BoundingBox, OfFewerThanTwoHasNoSize) {
  EXPECT_EQ(bounding_box(Points(0, 3)).diagonal(), 0);
  EXPECT_EQ(bounding_box(points_of({{4, 5, 6}})).diagonal(), 0);
}

}  // namespace
}  // namespace corral
