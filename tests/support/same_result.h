// SPDX-License-Identifier: MIT
#pragma once

// Answers of groupers that must not differ in a single bit.

#include <gtest/gtest.h>

#include "grouping/grouper.h"
#include "tests/support/execution.h"
#include "tests/support/reference/groupers.h"

namespace corral::testing {

inline void expect_same_result(const GroupingResult& found, const GroupingResult& expected) {
  EXPECT_EQ(found.selected, expected.selected);
  EXPECT_EQ(found.scores, expected.scores);
  ASSERT_EQ(found.target_from_source.has_value(), expected.target_from_source.has_value());
  if (!found.target_from_source) return;
  EXPECT_EQ(found.target_from_source->rotation, expected.target_from_source->rotation);
  EXPECT_EQ(found.target_from_source->translation, expected.target_from_source->translation);
}

inline void expect_reference(const GroupingResult& found, const reference::Selection& expected) {
  EXPECT_EQ(found.selected, expected.rows);
  EXPECT_EQ(found.scores, expected.scores);
}

inline void expect_same_on_every_target(const GroupFunction& group, const CorrespondenceSet& matches) {
  const GroupingResult expected = group(matches);
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    SCOPED_TRACE(target_name(each));
    expect_same_result(group(matches), expected);
  }
}

}  // namespace corral::testing
