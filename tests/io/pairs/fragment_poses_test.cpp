// SPDX-License-Identifier: MIT
#include "io/pairs/fragment_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::HasSubstr;

const std::string kPose = " 1\t 0\t 0\t 0\t\n 0\t 1\t 0\t 0\t\n 0\t 0\t 1\t 0\t\n 0\t 0\t 0\t 1\t\n";

std::string information(const std::string& head, int overlap) {
  std::string text = head + "\n";
  for (int row = 0; row < 6; ++row) text += std::to_string(overlap + row) + " 0 0 0 0 0\n";
  return text;
}

TEST(FragmentPoses, PairsWithTheirOverlap) {
  ScratchFolder folder;
  put_text(folder / "gt.log", "0\t 1\t 60\t\n" + kPose + "2\t 37\t 60\t\n" + kPose);
  put_text(folder / "gt.info", information("2\t 37\t 60", 1234));
  const auto pairs = read_fragment_pairs(folder / "gt.log", folder / "gt.info");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[1].source, 37);
  EXPECT_EQ(pairs[1].target, 2);
  EXPECT_EQ(pairs[1].overlap_points, 1234);
  EXPECT_FALSE(pairs[0].overlap_points);
  EXPECT_EQ(read_fragment_pairs(folder / "gt.log", "").size(), 2u);
}

TEST(FragmentPoses, WhatIsNoPairIsRefused) {
  ScratchFolder folder;
  const auto complaint = [&](const std::string& log, const std::string& info) -> std::string {
    put_text(folder / "gt.log", log);
    put_text(folder / "gt.info", info);
    try {
      read_fragment_pairs(folder / "gt.log", folder / "gt.info");
    } catch (const IoError& error) {
      return error.what();
    }
    return "nothing";
  };
  const std::string log = "0\t 1\t 60\t\n" + kPose;
  EXPECT_THAT(complaint(log + log, information("0 1 60", 3)), HasSubstr("twice"));
  EXPECT_THAT(complaint(log, "0 1\n"), HasSubstr("line 1"));
  EXPECT_THAT(complaint(log, "0 1 60\n1 2 3\n"), HasSubstr("expected six numbers"));
  EXPECT_THAT(complaint(log, "0 1 60\n1 0 0 0 0 0\n"), HasSubstr("six lines of six numbers"));
}

}  // namespace
}  // namespace corral
