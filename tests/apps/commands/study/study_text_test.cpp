// SPDX-License-Identifier: MIT
#include "apps/commands/study/study_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corral {
namespace {

TEST(StudyText, DurationInItsUnit) {
  EXPECT_EQ(duration(0.4), "0 s");
  EXPECT_EQ(duration(119), "119 s");
  EXPECT_EQ(duration(150), "2 min");
  EXPECT_EQ(duration(9000), "2.5 h");
}

TEST(StudyText, ProgressBeginsWithWhatALongStudyTakes) {
  StudyProgress now;
  now.total = 10, now.done = 3, now.failed = 1;
  now.expected_s = 9.9;
  EXPECT_EQ(progress_text(now, true), "3 of 10 pairs done, 1 failed");
  now.expected_s = 600;
  EXPECT_EQ(progress_text(now, true), "3 of 10 pairs done, 1 failed, expected to take about 10 min on one processor");
  EXPECT_EQ(progress_text(now, false), "3 of 10 pairs done, 1 failed") << "the bar then says what is left";
}

}  // namespace
}  // namespace corral
