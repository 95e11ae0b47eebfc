// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "kernel/number_text.h"
#include "tests/io/mesh/pcd_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AnyOf;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::intricate_pcd;
using testing::pcd_file;
using testing::PcdEntries;
using testing::PlyRow;
using testing::replaced;
using testing::square_pcd;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::string kPath = "folder/cloud.pcd";

std::string refusal(const std::string& content) {
  return complaint(kPath, [&] { parse_pcd(kPath, content); });
}

void expect_square(const Mesh& mesh) {
  Points vertices(4, 3);
  vertices << 0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5;
  EXPECT_EQ(mesh.vertices, vertices);
  EXPECT_EQ(mesh.triangles.rows(), 0);
}

/// One point of three values of one type.
std::string one_point(bool binary, char type, const std::string& type_name, const std::string& size, double value,
                      double other) {
  PcdEntries entries;
  entries.sizes = size + " " + size + " " + size;
  entries.types = type_name + " " + type_name + " " + type_name;
  entries.width = entries.points = "1";
  return pcd_file(binary, entries.text(), {{{type, value}, {type, other}, {type, 1}}});
}

/// One test for each encoding.
class Pcd : public ::testing::TestWithParam<bool> {
 protected:
  bool is_binary() const { return GetParam(); }
  std::string square(const PcdEntries& entries = {}) const { return square_pcd(is_binary(), entries); }
};

TEST_P(Pcd, ReadsPoints) {
  expect_square(parse_pcd(kPath, square()));
  const testing::ScratchFolder folder;
  expect_square(read_mesh(testing::put_text(folder / "a.PCD", square())));
}

TEST_P(Pcd, FindsThePointsAmongEverythingElse) {
  Points expected(4, 3);
  expected << 1.5, -300, 0.1, 2.5, 300, 0.2, 3.5, 32767, -0.3, 4.5, -32768, 1e300;
  EXPECT_EQ(parse_pcd(kPath, intricate_pcd(is_binary())).vertices, expected);
}

TEST_P(Pcd, ReadsEveryTypeExactly) {
  const std::string types = "bBhHiIfd";
  const std::vector<std::string> names = {"I", "U", "I", "U", "I", "U", "F", "F"};
  const std::vector<std::string> sizes = {"1", "1", "2", "2", "4", "4", "4", "8"};
  const std::vector<double> low = {-128, 0, -32768, 0, -2147483648.0, 0, -std::ldexp(1.0, 127), -0.0};
  const std::vector<double> high = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0, 0.1F, 5e-324};
  for (std::size_t i = 0; i < types.size(); ++i) {
    const Mesh mesh = parse_pcd(kPath, one_point(is_binary(), types[i], names[i], sizes[i], low[i], high[i]));
    EXPECT_EQ(mesh.vertices, Eigen::RowVector3d(low[i], high[i], 1)) << names[i] << sizes[i];
    EXPECT_EQ(std::signbit(mesh.vertices(0, 0)), std::signbit(low[i])) << names[i] << sizes[i];
  }
}

TEST_P(Pcd, ReadsWholeNumbersOfEightBytes) {
  PcdEntries entries;
  entries.sizes = "8 8 8";
  entries.types = "I I U";
  entries.width = entries.points = "1";
  const std::string body =
      is_binary() ? std::string(7, '\0') + '\x80' + std::string(7, '\xff') + '\x7f' + std::string(8, '\xff')
                  : "-9223372036854775808 9223372036854775807 18446744073709551615\n";
  EXPECT_EQ(parse_pcd(kPath, pcd_file(is_binary(), entries.text(), {}) + body).vertices,
            Eigen::RowVector3d(-std::ldexp(1.0, 63), std::ldexp(1.0, 63), std::ldexp(1.0, 64)));
}

TEST_P(Pcd, AcceptsItsVariants) {
  PcdEntries entries;
  for (const char* version : {".7", "0.6", ".6"}) {
    entries.version = version;
    expect_square(parse_pcd(kPath, square(entries)));
  }
  expect_square(parse_pcd(kPath, replaced(square(), "VIEWPOINT 0 0 0 1 0 0 0\n", "")));
  expect_square(parse_pcd(kPath, replaced(square(), "COUNT 1 1 1\n", "")));
  expect_square(parse_pcd(kPath, replaced(square(), "WIDTH", "# a grid\n\nWIDTH")));
  entries.width = entries.height = "2";
  expect_square(parse_pcd(kPath, square(entries)));
  entries.width = entries.points = "0";
  EXPECT_EQ(parse_pcd(kPath, pcd_file(is_binary(), entries.text(), {})).vertices.rows(), 0);
}

TEST_P(Pcd, TheViewpointIsNotApplied) {
  expect_square(parse_pcd(kPath, replaced(square(), "VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 9 9 9 0 1 0 0")));
  for (const char* bad : {"", " 0 0 0 1 0 0", " 0 0 0 1 0 0 0 0", " 0 0 0 1 0 0 x", " 0 0 0 1 0 0 nan"})
    EXPECT_THAT(refusal(replaced(square(), " 0 0 0 1 0 0 0", bad)), HasSubstr(", line 9: ")) << bad;
}

TEST_P(Pcd, AcceptsCrLf) {
  const std::string content = square();
  const std::size_t body = content.find("DATA"), start = content.find('\n', body) + 1;
  const std::string rest = content.substr(start);
  expect_square(parse_pcd(
      kPath, replaced(content.substr(0, start), "\n", "\r\n") + (is_binary() ? rest : replaced(rest, "\n", "\r\n"))));
}

/// The last number of a text may be cut, as far as counts can tell.
TEST_P(Pcd, TruncationAtEveryByteIsAnError) {
  for (const std::string& whole : {square(), intricate_pcd(is_binary())})
    for (std::size_t length = 0; length < (is_binary() ? whole.size() : whole.rfind(' ') + 2); ++length)
      EXPECT_NE(refusal(whole.substr(0, length)), "") << "cut at byte " << length << " of " << whole.size();
}

TEST_P(Pcd, BytesAfterTheLastPointAreNoted) {
  const StoredMesh cloud = parse_pcd(kPath, square() + "0 0 0\n");
  expect_square(cloud);
  EXPECT_THAT(cloud.notes, ElementsAre("6 bytes after the last point that the file promises were not read"));
}

TEST_P(Pcd, AHeaderThatPromisesMoreFailsAtOnce) {
  for (const char* count : {"5", "1000", "2147483647"}) {
    PcdEntries entries;
    entries.width = entries.points = count;
    EXPECT_NE(refusal(square(entries)), "") << count;
    entries.width = entries.height = "46340";
    entries.points = "2147395600";
    EXPECT_THAT(refusal(square(entries)), HasSubstr("promises 2147395600 points of "));
  }
  PcdEntries entries;
  entries.width = entries.points = "4294967295";
  EXPECT_EQ(refusal(square(entries)), ", line 7: WIDTH is '4294967295', expected a whole number in 0 .. 2147483647");
}

TEST_P(Pcd, ACountOfValuesThatLiesFailsAtOnce) {
  PcdEntries entries;
  entries.fields = "x y z bins";
  entries.sizes = "4 4 4 4";
  entries.types = "F F F F";
  for (const char* count : {"1", "2", "500000000"}) {
    entries.counts = "1 1 1 " + std::string(count);
    EXPECT_THAT(refusal(square(entries)), AnyOf(HasSubstr("promises 4 points of "), HasSubstr("found 3 values")))
        << count;
  }
  for (const char* count : {"0", "-20", "1.0", "2147483648"}) {
    entries.counts = "1 1 1 " + std::string(count);
    EXPECT_EQ(refusal(square(entries)), ", line 6: the count of field 'bins' is '" + std::string(count) +
                                            "', expected a whole number in 1 .. 2147483647");
  }
  entries.counts = "1 1 1 2147483647";
  EXPECT_EQ(refusal(square(entries)), ", line 6: a point takes more bytes than can be counted");
  entries.counts = "1 1 2 1";
  EXPECT_EQ(refusal(square(entries)), ", line 6: the count of field 'z' is 2, expected 1");
}

TEST_P(Pcd, MissingReturnsAreLeftOut) {
  const auto file = [&](double x, double y, double z) {
    PcdEntries entries;
    entries.width = entries.points = "3";
    return pcd_file(is_binary(), entries.text(),
                    {{{'f', 1}, {'f', 2}, {'f', 3}}, {{'f', x}, {'f', y}, {'f', z}}, {{'f', 4}, {'f', 5}, {'f', 6}}});
  };
  Points expected(2, 3);
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(parse_pcd(kPath, file(kNan, kNan, kNan)).vertices, expected);
  EXPECT_EQ(parse_pcd(kPath, file(0, kNan, 0)).vertices, expected) << "one is enough";
  EXPECT_THAT(parse_pcd(kPath, file(0, kNan, 0)).notes, ElementsAre("1 vertex with a nan coordinate was left out"));
  for (const double bad : {kInfinity, -kInfinity})
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(refusal(file(axis == 0 ? bad : 0, axis == 1 ? bad : 0, axis == 2 ? bad : 0)),
                is_binary() ? ", byte " + std::to_string(12 + 4 * axis) + " after the header: found " + to_text(bad) +
                                  " in point 1 of 3, expected a finite coordinate"
                            : ", line 13: found '" + to_text(bad) + "', expected a finite number");
  EXPECT_NE(refusal(file(kNan, kNan, kInfinity)), "");
}

TEST_P(Pcd, WhatIsNoCoordinateMayBeNan) {
  PcdEntries entries;
  entries.fields = "normal_x x y z";
  entries.sizes = "4 4 4 4";
  entries.types = "F F F F";
  entries.counts = "1 1 1 1";
  entries.width = entries.points = "1";
  const Mesh mesh =
      parse_pcd(kPath, pcd_file(is_binary(), entries.text(), {{{'f', kNan}, {'f', 1}, {'f', 2}, {'f', 3}}}));
  EXPECT_EQ(mesh.vertices, Eigen::RowVector3d(1, 2, 3));
}

INSTANTIATE_TEST_SUITE_P(EveryEncoding, Pcd, ::testing::Bool(),
                         [](const auto& about) { return about.param ? "binary" : "ascii"; });

// The Point Cloud Library writes a binary file one page of memory longer than its points.
TEST(PcdBinary, APageOfZerosMayBeFilled) {
  const std::string content = square_pcd(true);
  const std::size_t header = content.size() - 48;
  for (const std::size_t page : {4096U, 16384U, 65536U}) {
    const std::string filled = content + std::string(page - header, '\0');
    expect_square(parse_pcd(kPath, filled));
    EXPECT_TRUE(parse_pcd(kPath, filled).notes.empty());
    for (const std::string& other : {filled + '\0', filled.substr(0, filled.size() - 1) + '\1'})
      EXPECT_THAT(parse_pcd(kPath, other).notes, ElementsAre(HasSubstr("bytes after the last point")));
  }
}

TEST(PcdText, LinesHoldWhatTheHeaderSays) {
  const std::string good = square_pcd(false);
  const auto with = [&](const std::string& to) { return refusal(replaced(good, "1 0 0.5\n", to)); };
  EXPECT_EQ(with("\n# by hand\n1 0 0.5\n"), "");
  EXPECT_EQ(with("1 0\n"), ", line 13: found 2 values, expected 3");
  EXPECT_EQ(with("1 0 0.5 0\n"), ", line 13: found 4 values, expected 3");
  EXPECT_EQ(with("1 0 x\n"), ", line 13: found 'x', expected a number");
  EXPECT_EQ(with("1 0 1e999\n"), ", line 13: found '1e999', expected a number");
  EXPECT_EQ(with(""), ", line 15: the file ends here, expected point 3 of 4");
  EXPECT_EQ(refusal(replaced(intricate_pcd(false), "255", "256")),
            ", line 12: a value of type U1 is '256', expected a whole number in 0 .. 255");
  EXPECT_EQ(refusal(replaced(replaced(intricate_pcd(false), "4294967295", "-1"), "4 8 1 4", "8 8 1 4")),
            ", line 12: a value of type U8 is '-1', expected a whole number from 0");
}

}  // namespace
}  // namespace corral
