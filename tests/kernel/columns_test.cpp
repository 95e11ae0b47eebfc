// SPDX-License-Identifier: MIT
#include "kernel/columns.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace corral {
namespace {

TEST(Padded, IsTheNextMultipleOfTheLanes) {
  for (int count = 0; count < 40; ++count) {
    EXPECT_EQ(padded(count) % kLanes, 0);
    EXPECT_GE(padded(count), count);
    EXPECT_LT(padded(count), count + kLanes);
  }
}

TEST(AlignedColumn, StartsAtACacheLine) {
  for (std::size_t size = 1; size < 200; size += 13) {
    const AlignedColumn column(size, 1.0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % 64, 0u);
    EXPECT_EQ(column, AlignedColumn(column));
  }
}

}  // namespace
}  // namespace corral
