// SPDX-License-Identifier: MIT
#include "grouping/columns/canonical_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/row_order.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(CanonicalOrder, SortsByEachColumnInTurnAndByNumberLast) {
  CorrespondenceSet table =
      testing::table_of_points({{1, 0, 0}, {0, 5, 0}, {0, 5, 0}, {0, 4, 9}, {0, 5, 0}, {0, 5, 0}, {0, 5, 0}},
                               {{0, 0, 0}, {0, 0, 7}, {0, 0, 6}, {9, 9, 9}, {0, 0, 7}, {0, 0, 7}, {0, 0, 7}});
  table.feature_distance = testing::column_of({0, 2, 0, 0, 1, 2, 2});
  table.second_feature_distance = testing::column_of({0, 3, 0, 0, 9, 3, 3});
  testing::set_identity_frames(table);
  table.target_frames[1](2, 2) = 2;
  EXPECT_THAT(canonical_order(table), ElementsAre(3, 2, 4, 5, 6, 1, 0));
}

TEST(CanonicalOrder, AnswersComeBackInTheRowsOfTheTable) {
  const CorrespondenceSet table = testing::table_on_line({5, 3, 4, 1}, {0, 0, 0, 0});
  const GroupingResult result = group_in_canonical_order(table, [](const CorrespondenceSet& sorted) {
    GroupingResult found;
    found.selected = {0, 2};
    for (int row = 0; row < sorted.size(); ++row) found.scores.push_back(sorted.source_points(row, 0));
    return found;
  });
  EXPECT_THAT(result.selected, ElementsAre(2, 3));
  EXPECT_THAT(result.scores, ElementsAre(5, 3, 4, 1));
}

}  // namespace
}  // namespace corral
