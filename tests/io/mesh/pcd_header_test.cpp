// SPDX-License-Identifier: MIT
#include "io/mesh/pcd_header.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/io/mesh/pcd_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::complaint;
using testing::replaced;
using testing::square_pcd;

const std::string kPath = "folder/cloud.pcd";

std::string refusal(const std::string& content) {
  return complaint(kPath, [&] {
    LineReader reader(kPath, content, '#');
    parse_pcd_header(reader);
  });
}

TEST(PcdHeader, EndsWhereThePointsBegin) {
  const std::string content = square_pcd(true);
  LineReader reader(kPath, content, '#');
  const PcdHeader header = parse_pcd_header(reader);
  EXPECT_EQ(header.points, 4);
  EXPECT_EQ(header.bytes_per_point(), 12U);
  EXPECT_EQ(header.values_per_point(), 3U);
  EXPECT_EQ(header.encoding, PcdEncoding::Binary);
  EXPECT_EQ(reader.rest().size(), 48U);
}

TEST(PcdHeader, NamesTheLineOfAWrongEntry) {
  const std::string good = square_pcd(false);
  EXPECT_EQ(refusal("ply\n"), ", line 1: found 'ply', expected the entry VERSION");
  EXPECT_EQ(refusal("# .PCD\n"), ", line 2: the file ends here, expected the entry VERSION");
  const auto with = [&](const std::string& from, const std::string& to) { return refusal(replaced(good, from, to)); };
  EXPECT_EQ(with("VERSION 0.7", "VERSION 0.4"), ", line 2: found the version '0.4', expected 0.7, 0.6 or 0.5");
  EXPECT_EQ(with("VERSION 0.7", "VERSION"), ", line 2: VERSION has 0 values, expected 1");
  EXPECT_EQ(with("x y z", "x y w"), ", line 3: field 'z' is missing, expected fields x, y and z");
  EXPECT_EQ(with("x y z", "x y z x"), ", line 3: field 'x' occurs twice");
  EXPECT_EQ(with("x y z", ""), ", line 3: field 'x' is missing, expected fields x, y and z");
  EXPECT_EQ(with("SIZE 4 4 4", "SIZE 4 4"), ", line 4: SIZE has 2 values, expected 3");
  EXPECT_EQ(with("SIZE 4 4 4", "SIZE 4 4 3"), ", line 4: the size of field 'z' is '3', expected 1, 2, 4 or 8 bytes");
  EXPECT_EQ(with("SIZE 4 4 4\n", ""), ", line 4: found 'TYPE F F F', expected the entry SIZE");
  EXPECT_EQ(with("TYPE F F F", "TYPE F F"), ", line 5: TYPE has 2 values, expected 3");
  EXPECT_EQ(with("TYPE F F F", "TYPE F D F"), ", line 5: the type of field 'y' is 'D', expected I, U or F");
  EXPECT_EQ(with("SIZE 4 4 4", "SIZE 2 4 4"), ", line 5: field 'x' is of floating point with 2 bytes, expected 4 or 8");
  EXPECT_EQ(with("COUNT 1 1 1", "COUNT 1 1"), ", line 6: COUNT has 2 values, expected 3");
  EXPECT_EQ(with("WIDTH 4", "WIDTH -4"), ", line 7: WIDTH is '-4', expected a whole number in 0 .. 2147483647");
  EXPECT_EQ(with("HEIGHT 1", "HEIGHT 2"), ", line 10: POINTS is 4, expected WIDTH x HEIGHT, 4 x 2");
  EXPECT_EQ(with("POINTS 4", "POINTS 5"), ", line 10: POINTS is 5, expected WIDTH x HEIGHT, 4 x 1");
  EXPECT_EQ(with("POINTS 4\n", ""), ", line 10: found 'DATA ascii', expected the entry POINTS");
  EXPECT_EQ(with("POINTS 4\n", "POINTS 4\nPOINTS 4\n"), ", line 11: found 'POINTS 4', expected the entry DATA");
  EXPECT_EQ(with("DATA ascii", "DATA utf8"),
            ", line 11: found the data 'utf8', expected ascii, binary or binary_compressed");
  EXPECT_EQ(with("DATA ascii", "DATA"), ", line 11: DATA has 0 values, expected 1");
}

}  // namespace
}  // namespace corral
