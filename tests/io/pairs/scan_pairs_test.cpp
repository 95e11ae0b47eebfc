// SPDX-License-Identifier: MIT
#include "io/pairs/scan_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::HasSubstr;

// As published: the header names one entry of the matrix less than there are.
const std::string kHeader =
    "seq i seq_db j mot1 mot2 mot3 mot4 mot5 mot6 mot7 mot8 mot9 mot10 mot11 mot12 mot13 mot14 mot15\n";
const std::string kPose =
    " 0.000000 -1.000000 0.000000 5.500000 1.000000 0.000000 0.000000 -2.000000 0.000000 0.000000 1.000000 0.250000 "
    "0.000000 0.000000 0.000000 1.000000";

TEST(ScanPairs, AListOfTheBenchmark) {
  ScratchFolder folder;
  const std::string path =
      put_text(folder / "test.txt", kHeader + "8 0 8 11" + kPose + "\n8 1500 8 20" + kPose + " 0.625\n");
  EXPECT_TRUE(is_scan_list(path));
  const std::vector<ScanPair> pairs = read_scan_list(path);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].source_sequence, 8);
  EXPECT_EQ(pairs[0].source, 0);
  EXPECT_EQ(pairs[0].target_sequence, 8);
  EXPECT_EQ(pairs[0].target, 11);
  EXPECT_EQ(pairs[0].target_from_source.translation, Eigen::Vector3d(5.5, -2, 0.25));
  EXPECT_EQ(pairs[0].target_from_source.rotation(1, 0), 1) << "row by row";
  EXPECT_EQ(pairs[0].target_from_source.rotation(0, 1), -1);
  EXPECT_FALSE(pairs[0].overlap);
  EXPECT_EQ(pairs[1].source, 1500);
  EXPECT_EQ(pairs[1].overlap, 0.625);
}

TEST(ScanPairs, OtherTextIsNoList) {
  ScratchFolder folder;
  EXPECT_FALSE(is_scan_list(put_text(folder / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n")));
  EXPECT_FALSE(is_scan_list(put_text(folder / "short.txt", "seq i seq_db\n")));
  EXPECT_FALSE(is_scan_list(folder / "absent.txt"));
}

TEST(ScanPairs, EveryMalformedLineIsNamed) {
  ScratchFolder folder;
  const auto complaint = [&](const std::string& lines) -> std::string {
    const std::string path = put_text(folder / "test.txt", kHeader + lines);
    try {
      read_scan_list(path);
    } catch (const IoError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(complaint(""), HasSubstr("a pair of scans"));
  EXPECT_THAT(complaint("8 0 8 11 1 0 0\n"), HasSubstr("line 2: found 7 fields"));
  EXPECT_THAT(complaint("8 0 8 -1" + kPose + "\n"), HasSubstr("line 2"));
  EXPECT_THAT(complaint("8 0.5 8 1" + kPose + "\n"), HasSubstr("a scan"));
  EXPECT_THAT(complaint("8 0 8 11" + kPose + "\n8 0 8 11" + kPose + "\n"),
              HasSubstr("line 3: the pair is there twice"));
  EXPECT_THAT(complaint("8 0 8 11 1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1\n"), HasSubstr("line 2"));
  EXPECT_THAT(complaint("8 0 8 11 nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"), HasSubstr("nan"));
}

}  // namespace
}  // namespace corral
