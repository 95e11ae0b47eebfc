// SPDX-License-Identifier: MIT
#include "apps/commands/pair/pair_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/plan.h"

namespace corral {
namespace {

// Measured: 33 s for ST with half of the matches correct, 12 s for SI, under a second for the others (grouping/README.md).
TEST(CallText, SaysWhatALongCallTakes) {
  EXPECT_EQ(call_text("st", 100000, 1), "st on 100000 matches, expected to take about 40 s");
  EXPECT_EQ(call_text("si", 100000, 1), "si on 100000 matches, expected to take about 13 s");
  EXPECT_EQ(call_text("st", 5000, 1), "st on 5000 matches");
  EXPECT_EQ(call_text("gc", 100000, 1), "gc on 100000 matches");
  EXPECT_EQ(call_text("st", 40000, 3), "st on 40000 matches, expected to take about 19 s") << "in three calls";
}

TEST(CallText, IsWhatThePlanExpects) {
  for (const std::uint64_t matches : {0u, 1u, 1000u, 200000u}) {
    EXPECT_GE(call_nanoseconds("st", matches), call_nanoseconds("si", matches));
    EXPECT_GE(call_nanoseconds("si", matches), call_nanoseconds("gc", matches));
    EXPECT_LT(call_nanoseconds("gc", matches), call_nanoseconds("gc", matches + 1));
  }
}

}  // namespace
}  // namespace corral
