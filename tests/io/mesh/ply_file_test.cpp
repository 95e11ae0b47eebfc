// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "tests/io/mesh/ply_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::intricate_ply;
using testing::ply_file;
using testing::PlyRow;
using testing::PlyValue;
using testing::replaced;
using testing::square_ply;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::string kPath = "folder/mesh.ply";
const std::string kVertex = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

std::string refusal(const std::string& content) {
  return complaint(kPath, [&] { parse_ply(kPath, content); });
}

/// Three vertices, the second at (x, 1, 2).
std::vector<PlyRow> three_vertices(double x = 1) {
  return {{{'d', 0}, {'d', 0}, {'d', 0}}, {{'d', x}, {'d', 1}, {'d', 2}}, {{'d', 0}, {'d', 1}, {'d', 0}}};
}

std::vector<PlyRow> with_rows(std::vector<PlyRow> rows, const std::vector<PlyRow>& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

Eigen::MatrixXi triangles_of(const std::vector<std::vector<int>>& rows) {
  Eigen::MatrixXi triangles(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i)
    triangles.row(static_cast<Eigen::Index>(i)) = Eigen::RowVector3i(rows[i].data());
  return triangles;
}

/// One test for each encoding.
class Ply : public ::testing::TestWithParam<std::string> {
 protected:
  std::string format() const { return GetParam(); }
  bool is_text() const { return format() == "ascii"; }
};

TEST_P(Ply, ReadsASquareAsTwoTriangles) {
  const Mesh mesh = parse_ply(kPath, square_ply(format()));
  Points expected(4, 3);
  expected << 0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5;
  EXPECT_EQ(mesh.vertices, expected);
  EXPECT_EQ(mesh.triangles, triangles_of({{0, 1, 2}, {0, 2, 3}}));
}

TEST_P(Ply, FindsTheMeshAmongEverythingElse) {
  const Mesh mesh = parse_ply(kPath, intricate_ply(format()));
  Points expected(4, 3);
  expected << 1.5, -300, 0.1, 2.5, 300, 0.2, 3.5, 32767, -0.3, 4.5, -32768, 1e300;
  EXPECT_EQ(mesh.vertices, expected);
  EXPECT_EQ(mesh.triangles, triangles_of({{0, 1, 2}, {0, 2, 3}, {3, 1, 0}}));
}

TEST_P(Ply, FacesMayComeBeforeVertices) {
  const auto file = [&](int corner) {
    const PlyRow face = {{'B', 3}, {'i', 0}, {'i', static_cast<double>(corner)}, {'i', 1}};
    return ply_file(format(), kFace + kVertex, with_rows({face}, three_vertices()));
  };
  EXPECT_EQ(parse_ply(kPath, file(2)).triangles, triangles_of({{0, 2, 1}}));
  EXPECT_THAT(refusal(file(3)), HasSubstr("a corner is vertex 3, expected 0 .. 2"));
  EXPECT_THAT(refusal(file(-1)), HasSubstr("a corner is -1, expected 0 .. 2"));
}

TEST_P(Ply, ReadsEveryTypeExactly) {
  const std::string types = "bBhHiIfd";
  const std::vector<std::string> names = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  const std::vector<double> low = {-128, 0, -32768, 0, -2147483648.0, 0, -std::ldexp(1.0, 127), -0.0};
  const std::vector<double> high = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0, 0.1F, 5e-324};
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string line = "property " + names[i] + " ";
    const Mesh mesh =
        parse_ply(kPath, ply_file(format(), "element vertex 1\n" + line + "x\n" + line + "y\n" + line + "z\n",
                                  {{{types[i], low[i]}, {types[i], high[i]}, {types[i], 1}}}));
    EXPECT_EQ(mesh.vertices, Eigen::RowVector3d(low[i], high[i], 1)) << names[i];
    EXPECT_EQ(std::signbit(mesh.vertices(0, 0)), std::signbit(low[i])) << names[i];
  }
}

TEST_P(Ply, ReadsAPointCloudAndAnEmptyOne) {
  EXPECT_EQ(parse_ply(kPath, ply_file(format(), kVertex, three_vertices())).triangles.rows(), 0);
  EXPECT_EQ(parse_ply(kPath, ply_file(format(), replaced(kVertex, "3", "0"), {})).vertices.rows(), 0);
}

TEST_P(Ply, AcceptsCrLf) {
  const std::string content = square_ply(format());
  const std::size_t body = content.find("end_header\n") + 11;
  const std::string header = replaced(content.substr(0, body), "\n", "\r\n");
  const std::string rest = is_text() ? replaced(content.substr(body), "\n", "\r\n") : content.substr(body);
  EXPECT_EQ(parse_ply(kPath, header + rest).vertices, parse_ply(kPath, content).vertices);
}

// The last number of a text may be cut, as far as counts can tell.
TEST_P(Ply, TruncationAtEveryByteIsAnError) {
  for (const std::string& whole : {square_ply(format()), intricate_ply(format())})
    for (std::size_t length = 0; length < (is_text() ? whole.rfind(' ') + 2 : whole.size()); ++length)
      EXPECT_NE(refusal(whole.substr(0, length)), "") << "cut at byte " << length << " of " << whole.size();
}

TEST_P(Ply, BytesAfterTheLastElementAreNoted) {
  for (const std::string more : {"4", "3 0 1 2\n"}) {
    const StoredMesh mesh = parse_ply(kPath, square_ply(format()) + more);
    EXPECT_EQ(mesh.triangles, triangles_of({{0, 1, 2}, {0, 2, 3}}));
    EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr(std::to_string(more.size()) + " byte")));
  }
}

TEST_P(Ply, AHeaderThatPromisesMoreFailsAtOnce) {
  for (const char* count : {"5", "1000", "2000000000", "2147483647"}) {
    EXPECT_NE(refusal(replaced(square_ply(format()), "vertex 4", "vertex " + std::string(count))), "") << count;
    EXPECT_NE(refusal(replaced(square_ply(format()), "face 1", "face " + std::string(count))), "") << count;
    EXPECT_NE(refusal(replaced(intricate_ply(format()), "camera 2", "camera " + std::string(count))), "") << count;
  }
  EXPECT_THAT(refusal(replaced(square_ply(format()), "vertex 4", "vertex 2000000000")),
              AllOf(HasSubstr("promises 2000000000 of element 'vertex'"), HasSubstr("bytes follow")));
}

TEST_P(Ply, ListsThatLieAreErrors) {
  const auto file = [&](const std::string& type, const PlyValue& count) {
    return ply_file(format(), kVertex + "element face 1\nproperty list " + type + " int vertex_indices\n",
                    with_rows(three_vertices(), {{count, {'i', 0}, {'i', 1}, {'i', 2}}}));
  };
  EXPECT_EQ(refusal(file("uchar", {'B', 3})), "");
  EXPECT_NE(refusal(file("uchar", {'B', 4})), "");
  EXPECT_NE(refusal(file("uchar", {'B', 2})), "") << "one value is left over";
  EXPECT_THAT(refusal(file("uchar", {'B', 255})), HasSubstr("a list of 255 values, expected no more than follow"));
  EXPECT_THAT(refusal(file("int", {'i', -1})), HasSubstr("a list of -1 values"));
  EXPECT_THAT(refusal(file("int", {'i', 2147483647.0})), HasSubstr("a list of 2147483647 values"));
  EXPECT_THAT(refusal(file("uint", {'I', 4294967295.0})), HasSubstr("a list of 4294967295 values"));
}

TEST_P(Ply, AFaceHasThreeCorners) {
  for (const double size : {0, 1, 2}) {
    PlyRow face = {{'B', size}};
    for (double corner = 0; corner < size; ++corner) face.push_back({'i', corner});
    EXPECT_THAT(refusal(ply_file(format(), kVertex + kFace, with_rows(three_vertices(), {face}))),
                HasSubstr("a face of " + std::to_string(static_cast<int>(size)) + " corners"));
  }
}

TEST_P(Ply, WhatIsNoCoordinateMayBeNan) {
  const std::string header = "comment first\n" + kVertex + "property float nx\n";
  std::vector<PlyRow> rows = three_vertices();
  for (PlyRow& row : rows) row.push_back({'f', kNan});
  EXPECT_EQ(parse_ply(kPath, ply_file(format(), header, rows)).vertices.rows(), 3);
}

TEST_P(Ply, NothingStandsTwice) {
  EXPECT_THAT(refusal(ply_file(format(), kVertex + "property float x\n", {})), HasSubstr("property 'x' occurs twice"));
  EXPECT_THAT(refusal(ply_file(format(), kVertex + kVertex, {})), HasSubstr("element 'vertex' occurs twice"));
}

TEST_P(Ply, CoordinatesAreFinite) {
  for (const double bad : {kInfinity, -kInfinity}) {
    EXPECT_THAT(refusal(ply_file(format(), kVertex, three_vertices(bad))), HasSubstr("finite"));
    const std::string floats = replaced(kVertex, "double", "float");
    EXPECT_THAT(
        refusal(ply_file(
            format(), floats,
            {{{'f', 0}, {'f', 0}, {'f', 0}}, {{'f', 0}, {'f', 0}, {'f', 0}}, {{'f', 0}, {'f', 0}, {'f', bad}}})),
        HasSubstr("finite"));
  }
  EXPECT_THAT(refusal(ply_file(format(), kVertex, three_vertices(kInfinity))),
              is_text() ? HasSubstr("line 9: ") : HasSubstr("byte 24 after the header: "));
}

TEST_P(Ply, CornersAreVertices) {
  for (const double bad : {3.0, 2147483647.0, -1.0, -2147483648.0}) {
    const PlyRow face = {{'B', 3}, {'i', 0}, {'i', 1}, {'i', bad}};
    EXPECT_THAT(refusal(ply_file(format(), kVertex + kFace, with_rows(three_vertices(), {face}))),
                HasSubstr("a corner is"));
  }
  const PlyRow face = {{'B', 3}, {'I', 0}, {'I', 1}, {'I', 4294967295.0}};
  EXPECT_THAT(
      refusal(ply_file(format(), kVertex + replaced(kFace, " int", " uint"), with_rows(three_vertices(), {face}))),
      HasSubstr("a corner is"));
}

INSTANTIATE_TEST_SUITE_P(EveryEncoding, Ply, ::testing::ValuesIn(testing::kPlyFormats),
                         [](const auto& about) { return about.param; });

TEST(PlyHeader, NamesTheLineOfWhatItDoesNotKnow) {
  const auto header = [](const std::string& declarations) {
    return refusal(ply_file("ascii", declarations, three_vertices()));
  };
  EXPECT_EQ(header(kVertex), "");
  EXPECT_THAT(refusal("PLY\n"), HasSubstr("line 1: found 'PLY', expected the word ply"));
  EXPECT_THAT(refusal("ply\nformat ascii 2.0\n"), HasSubstr("line 2: found 'format ascii 2.0', expected 'format"));
  EXPECT_THAT(refusal("ply\nformat utf8 1.0\n"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("ply\nelement vertex 0\n"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nend_header\n"), HasSubstr("header: no element vertex, expected one"));
  EXPECT_THAT(header(kVertex + "element vertex 3\n"), HasSubstr("line 7: element 'vertex' occurs twice"));
  EXPECT_THAT(header("property float x\n"), HasSubstr("line 3: found 'property float x', expected an element"));
  EXPECT_THAT(header(kVertex + "property long x\n"), HasSubstr("line 7: found the type 'long', expected char, uchar"));
  EXPECT_THAT(header(kVertex + "property list float int a\n"),
              HasSubstr("line 7: the length of a list is of type 'float'"));
  EXPECT_THAT(header(kVertex + "property list uchar int\n"),
              HasSubstr("line 7: found 'property list uchar int', expected"));
  EXPECT_THAT(header(kVertex + "property\n"), HasSubstr("line 7"));
  EXPECT_THAT(header(kVertex + "nonsense\n"), HasSubstr("line 7: found 'nonsense'"));
  for (const char* count : {"-1", "1.5", "x", "2147483648", "99999999999999999999"})
    EXPECT_THAT(header("element vertex " + std::string(count) + "\n"),
                HasSubstr("line 3: the number of elements is '" + std::string(count) + "'"));
}

TEST(PlyHeader, NeedsCoordinatesAndCorners) {
  const auto header = [](const std::string& declarations) {
    return refusal(ply_file("ascii", declarations, three_vertices()));
  };
  EXPECT_THAT(header(replaced(kVertex, "double z", "double w")), HasSubstr("expected properties x, y and z"));
  EXPECT_THAT(header(replaced(kVertex, "double z", "list uchar double z")),
              HasSubstr("expected properties x, y and z"));
  EXPECT_THAT(header(kVertex + replaced(kFace, "vertex_indices", "corners")), HasSubstr("face lacks its corners"));
  EXPECT_THAT(header(kVertex + replaced(kFace, "list uchar int", "int")), HasSubstr("face lacks its corners"));
  EXPECT_THAT(header(kVertex + replaced(kFace, "uchar int", "uchar float")), HasSubstr("face lacks its corners"));
}

// Corners would be checked against a number of vertices that have no place.
TEST(PlyHeader, VerticesWithoutPropertiesAreRefused) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\n";
  EXPECT_THAT(refusal(header + kFace + "end_header\n3 0 1 2\n"), HasSubstr("lacks a coordinate"));
  EXPECT_THAT(
      refusal(header + "obj_info num_cols 1\nobj_info num_rows 1\nelement range_grid 1\nproperty list uchar int "
                       "vertex_indices\nend_header\n1 2\n"),
      HasSubstr("lacks a coordinate"));
}

TEST(PlyHeader, ThousandsOfNamesAreRefused) {
  std::string header = "ply\nformat ascii 1.0\nelement vertex 0\n";
  for (int i = 0; i < 2000; ++i) header += "property float p" + std::to_string(i) + "\n";
  EXPECT_THAT(refusal(header + "end_header\n"), HasSubstr("more than 1000 elements and properties"));
}

TEST(PlyText, FacesOfItsOwnComeBeforeThoseOfTheGrid) {
  const std::string grid = "element range_grid 4\nproperty list uchar int vertex_indices\n";
  const std::string rows = "0 0 0\n0 1 2\n0 1 0\n3 0 1 2\n1 0\n1 1\n1 2\n0\n";
  const StoredMesh mesh = parse_ply(kPath,
                                    "ply\nformat ascii 1.0\nobj_info num_cols 2\nobj_info num_rows 2\nobj_info "
                                    "num_cols unknown words\n" +
                                        kVertex + kFace + grid + "end_header\n" + rows);
  EXPECT_EQ(mesh.triangles.rows(), 1);
  EXPECT_THAT(mesh.notes, ::testing::ElementsAre(HasSubstr("the range grid was not read")));
}

TEST(PlyText, RowsHoldWhatTheHeaderSays) {
  const std::string header = "ply\nformat ascii 1.0\n" + kVertex + "end_header\n0 0 0\n";
  EXPECT_EQ(refusal(header + "\n1 2 3\n4 5 6\n\n"), "");
  EXPECT_THAT(refusal(header + "1 2\n4 5 6\n"), HasSubstr("line 9: found 2 values, expected more"));
  EXPECT_THAT(refusal(header + "1 2 3 4\n4 5 6\n"), HasSubstr("line 9: found 4 values, expected 3"));
  EXPECT_THAT(refusal(header + "1 2 x\n4 5 6\n"), HasSubstr("line 9: found 'x', expected a number"));
  EXPECT_THAT(refusal(header + "1 2 1e999\n4 5 6\n"), HasSubstr("line 9: found '1e999'"));
  EXPECT_THAT(refusal(header + "1 2 3\n"), HasSubstr("line 10: the file ends here, expected element 'vertex' 2 of 3"));
}

}  // namespace
}  // namespace corral
