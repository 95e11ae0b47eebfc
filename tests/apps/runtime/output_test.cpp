// SPDX-License-Identifier: MIT
#include "apps/runtime/output.h"

#include <gtest/gtest.h>

#include "tests/io/scratch.h"

namespace corral {
namespace {

TEST(Put, WritesAFileOrStandardOutput) {
  const testing::ScratchFolder folder;
  put(folder / "a.txt", std::string("text"));
  put(folder / "a.json", Json{{"a", 0.1}});
  EXPECT_EQ(testing::text_of(folder / "a.txt"), "text");
  EXPECT_EQ(testing::text_of(folder / "a.json"), "{\n  \"a\": 0.1\n}\n");
  ::testing::internal::CaptureStdout();
  put("", std::string("text\n"));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "text\n");
}

}  // namespace
}  // namespace corral
