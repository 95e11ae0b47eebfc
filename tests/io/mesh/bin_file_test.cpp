// SPDX-License-Identifier: MIT
#include "io/mesh/bin_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kernel/error.h"
#include "tests/io/array/npy_encoder.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(BinFile, PointsOfAScan) {
  const StoredMesh cloud = parse_bin("a.bin", raw<float>({1, 2, 3, 0.5, -4, 5.5, 6, 0.25}));
  Points expected(2, 3);
  expected << 1, 2, 3, -4, 5.5, 6;
  EXPECT_EQ(cloud.vertices, expected);
}

TEST(BinFile, MissingPointsAreLeftOutAndWhatIsNoScanIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const StoredMesh cloud = parse_bin("a.bin", raw<float>({1, 2, 3, 0, nan, 5, 6, 0}));
  EXPECT_EQ(cloud.vertices.rows(), 1);
  EXPECT_THAT(cloud.notes, ElementsAre(HasSubstr("left out")));
  const auto complaint = [](const std::string& content) -> std::string {
    try {
      parse_bin("a.bin", content);
    } catch (const IoError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(complaint(raw<float>({1, 2, 3})), HasSubstr("byte 12"));
  EXPECT_THAT(complaint(raw<float>({1, 2, 3, 0, 1, inf, 3, 0})), HasSubstr("byte 20"));
}

}  // namespace
}  // namespace corral
