// SPDX-License-Identifier: MIT
#include "apps/runtime/text_table.h"

#include <gtest/gtest.h>

namespace corral {
namespace {

TEST(Fixed, HasSoManyDecimals) {
  EXPECT_EQ(fixed(1.25, 3), "1.250");
  EXPECT_EQ(fixed(2.0 / 3, 2), "0.67");
  EXPECT_EQ(fixed(-7, 0), "-7");
  EXPECT_EQ(fixed(std::nullopt, 3), "");
}

TEST(Fixed, LargeNumbersAreNotCutShort) { EXPECT_EQ(std::stod(fixed(1e300, 3)), 1e300); }

TEST(TextTable, AlignsNumbersToTheRight) {
  TextTable table({"name", "count", "status"});
  table.add({"a", "1", "fine"});
  table.add({"longer", "123456", "x"});
  table.add({"b", "", ""});
  EXPECT_EQ(table.str(),
            "name     count  status\n"
            "a            1  fine\n"
            "longer  123456  x\n"
            "b            -  -\n");
}

TEST(TextTable, MarkdownEscapesItsBars) {
  TextTable table({"a", "b"});
  table.add({"x|y", ""});
  EXPECT_EQ(table.markdown(), "| a | b |\n| --- | --- |\n| x\\|y |  |\n");
}

}  // namespace
}  // namespace corral
