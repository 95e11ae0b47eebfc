// SPDX-License-Identifier: MIT
// Files as other programs write them: one sheet of 12 x 12 vertices in every variant, which must give the same mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lzf.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io/mesh/mesh_file.h"
#include "kernel/number_text.h"
#include "tests/io/mesh/ply_encoder.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using testing::complaint;
using ::testing::ElementsAre;
using testing::encode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::replaced;

constexpr int kSide = 12;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const char* const kOpenEnd = "the last line lacks its newline: the file may have been cut short there";
const std::string kFloats = "property float x\nproperty float y\nproperty float z\n";

Mesh make_sheet() {
  Mesh sheet = testing::grid(kSide, kSide);
  for (Eigen::Index row = 0; row < sheet.vertices.rows(); ++row) {
    const double x = sheet.vertices(row, 0), y = sheet.vertices(row, 1);
    sheet.vertices.row(row) << x, y, 1 + 0.25 * ((3 * static_cast<int>(x) + 5 * static_cast<int>(y)) % 7);
  }
  return sheet;
}
const Mesh kSheet = make_sheet();

/// A line per row: what stands in front of the numbers, and what behind.
std::string lines_of(const Points& rows, const std::string& before = "", const std::string& behind = "\n") {
  std::string text;
  for (Eigen::Index row = 0; row < rows.rows(); ++row)
    text += before + to_text(rows(row, 0)) + " " + to_text(rows(row, 1)) + " " + to_text(rows(row, 2)) + behind;
  return text;
}

std::string face_lines(const std::string& before, int base, const std::string& behind = "\n") {
  std::string text;
  for (Eigen::Index face = 0; face < kSheet.triangles.rows(); ++face) {
    text += before;
    for (int i = 0; i < 3; ++i) text += " " + std::to_string(kSheet.triangles(face, i) + base);
    text += behind;
  }
  return text;
}

const std::string kPlyHeader = "ply\nformat ascii 1.0\nelement vertex 144\n" + kFloats +
                               "element face 242\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPly = kPlyHeader + lines_of(kSheet.vertices) + face_lines("3", 0);
const std::string kOff = "OFF\n144 242 0\n" + lines_of(kSheet.vertices) + face_lines("3", 0);
const std::string kObj = lines_of(kSheet.vertices, "v ") + face_lines("f", 1);
const std::string kPcdHeader =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 144\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 144\nDATA ascii\n";
const std::string kPcd = kPcdHeader + lines_of(kSheet.vertices);

void expect_sheet(const StoredMesh& mesh) {
  EXPECT_EQ(mesh.vertices, kSheet.vertices);
  EXPECT_EQ(mesh.triangles, kSheet.triangles);
  EXPECT_THAT(mesh.notes, IsEmpty());
}

void expect_cloud(const StoredMesh& mesh) {
  EXPECT_EQ(mesh.vertices, kSheet.vertices);
  EXPECT_EQ(mesh.triangles.rows(), 0);
}

TEST(StrangerPly, StripsOfTrianglesAreFaces) {
  std::vector<int> strips;
  for (int row = 0; row + 1 < kSide; ++row) {
    for (int column = 0; column < kSide; ++column)
      for (const int up : {1, 0}) strips.push_back((row + up) * kSide + column);
    strips.push_back(-1);
  }
  for (const std::string& format : testing::kPlyFormats) {
    testing::PlyRow list = {{'i', static_cast<double>(strips.size())}};
    for (const int corner : strips) list.push_back({'i', static_cast<double>(corner)});
    std::vector<testing::PlyRow> rows;
    for (Eigen::Index row = 0; row < 144; ++row)
      rows.push_back({{'f', kSheet.vertices(row, 0)}, {'f', kSheet.vertices(row, 1)}, {'f', kSheet.vertices(row, 2)}});
    rows.push_back(list);
    const StoredMesh mesh =
        parse_ply("", testing::ply_file(format,
                                        "element vertex 144\n" + kFloats +
                                            "element tristrips 1\nproperty list int int vertex_indices\n",
                                        rows));
    ASSERT_EQ(mesh.triangles.rows(), 242);
    for (Eigen::Index face = 0; face < 242; ++face) {
      const auto corner = [&](int i) { return Eigen::Vector2d(mesh.vertices.row(mesh.triangles(face, i)).head<2>()); };
      const Eigen::Vector2d a = corner(1) - corner(0), b = corner(2) - corner(0);
      EXPECT_DOUBLE_EQ(a.x() * b.y() - a.y() * b.x(), 1) << "wound as the others, face " << face;
    }
  }
}

TEST(StrangerPly, AStripMayTurn) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 5\n" + kFloats +
                             "element tristrips 2\nproperty list uchar int vertex_indices\nend_header\n"
                             "0 0 1\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n";
  Triangles expected(3, 3);
  expected << 0, 1, 2, 2, 1, 3, 2, 3, 4;
  EXPECT_EQ(parse_ply("", header + "6 0 1 2 3 3 -1\n3 2 3 4\n").triangles, expected);
  EXPECT_THAT(complaint("", [&] { parse_ply("", header + "4 0 1 2 5\n3 2 3 4\n"); }),
              HasSubstr("line 15: a corner is vertex 5, expected 0 .. 4"));
  EXPECT_THAT(complaint("", [&] { parse_ply("", header + "4 0 1 -2 3\n3 2 3 4\n"); }), HasSubstr("a corner is -2"));
}

std::string grid_ply(const std::string& sizes) {
  std::string text = "ply\nformat ascii 1.0\n" + sizes + "element vertex 144\n" + kFloats +
                     "element range_grid 168\nproperty list uchar int vertex_indices\nend_header\n" +
                     lines_of(kSheet.vertices);
  for (int row = 0; row < kSide; ++row)
    for (int column = -1; column <= kSide; ++column)
      text += column < 0 || column == kSide ? "0\n" : "1 " + std::to_string(row * kSide + column) + "\n";
  return text;
}

TEST(StrangerPly, AGridOfRangeSamplesGivesFaces) {
  const StoredMesh mesh = parse_ply("", grid_ply("obj_info num_cols 14\nobj_info num_rows 12\n"));
  EXPECT_EQ(mesh.vertices, kSheet.vertices);
  EXPECT_EQ(mesh.triangles.rows(), 242);
  EXPECT_THAT(mesh.notes, IsEmpty());
  for (const char* sizes : {"", "obj_info num_cols 14\n", "obj_info num_cols 12\nobj_info num_rows 12\n"}) {
    const StoredMesh cloud = parse_ply("", grid_ply(sizes));
    expect_cloud(cloud);
    EXPECT_THAT(cloud.notes, ElementsAre(HasSubstr("the range grid of 168 cells gives no faces")));
  }
}

TEST(StrangerFiles, LinesMayEndInCarriageReturns) {
  for (const char* end : {"\r", "\r\n"}) {
    expect_sheet(parse_ply("", replaced(kPly, "\n", end)));
    expect_sheet(parse_off("", replaced(kOff, "\n", end)));
    expect_sheet(parse_obj("", replaced(kObj, "\n", end)));
    expect_cloud(parse_pcd("", replaced(kPcd, "\n", end)));
    expect_cloud(parse_xyz("", replaced(lines_of(kSheet.vertices), "\n", end)));
  }
}

// The first byte of the data is a line feed: behind CR it is not one.
TEST(StrangerFiles, BinaryDataMayFollowCarriageReturns) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar "
      "z\nend_header\n";
  for (const char* end : {"\r", "\n", "\r\n"})
    EXPECT_EQ(parse_ply("", replaced(header, "\n", end) + "\n\r\n").vertices, Eigen::RowVector3d(10, 13, 10));
}

TEST(StrangerFiles, WhatFollowsThePromisedElementsIsNoted) {
  const std::string more = "made by hand\n2 words\n";
  for (const StoredMesh& mesh : {parse_ply("", kPly + more), parse_off("", kOff + more)}) {
    EXPECT_EQ(mesh.triangles, kSheet.triangles);
    EXPECT_THAT(mesh.notes, ElementsAre(HasSubstr("21 bytes after the last ")));
  }
  const StoredMesh cloud = parse_pcd("", kPcd + "x\n");
  expect_cloud(cloud);
  EXPECT_THAT(cloud.notes, ElementsAre("2 bytes after the last point that the file promises were not read"));
  const StoredMesh binary = parse_ply("", binary_ply_text(kSheet) + "\n");
  EXPECT_EQ(binary.triangles, kSheet.triangles);
  EXPECT_THAT(binary.notes, ElementsAre("1 byte after the last element that the file promises was not read"));
}

TEST(StrangerFiles, AWholeFileMayLackItsLastNewline) {
  const auto open = [](const std::string& text) { return text.substr(0, text.size() - 1); };
  for (const StoredMesh& mesh : {parse_ply("", open(kPly)), parse_off("", open(kOff))}) {
    EXPECT_EQ(mesh.triangles, kSheet.triangles);
    EXPECT_THAT(mesh.notes, ElementsAre(kOpenEnd));
  }
  EXPECT_THAT(parse_pcd("", open(kPcd)).notes, ElementsAre(kOpenEnd));
  EXPECT_THAT(complaint("", [&] { parse_obj("", open(kObj)); }), HasSubstr("the file ends within this line"));
  EXPECT_THAT(complaint("", [&] { parse_xyz("", open(lines_of(kSheet.vertices))); }),
              HasSubstr("the file ends within this line"));
}

TEST(StrangerFiles, MissingPointsAreLeftOut) {
  Points holed = kSheet.vertices;
  for (const int row : {0, 7, 143}) holed(row, row % 3) = kNan;
  const std::string vertices = lines_of(holed);
  int used = 0;
  for (Eigen::Index face = 0; face < 242; ++face)
    for (int i = 0; i < 3; ++i) used += kSheet.triangles(face, i) % 143 == 0 || kSheet.triangles(face, i) == 7;
  const std::string note = "3 vertices with a nan coordinate";
  const std::string with_faces = note + " and " + std::to_string(used) + " faces that used them were left out";
  for (const StoredMesh& mesh : {parse_ply("", kPlyHeader + vertices + face_lines("3", 0)),
                                 parse_off("", "OFF\n144 242 0\n" + vertices + face_lines("3", 0)),
                                 parse_obj("", lines_of(holed, "v ") + face_lines("f", 1))}) {
    EXPECT_EQ(mesh.vertices.rows(), 141);
    EXPECT_EQ(mesh.vertices.row(6), kSheet.vertices.row(8));
    EXPECT_EQ(mesh.triangles.rows(), 242 - used);
    EXPECT_THAT(mesh.notes, ElementsAre(with_faces));
    mesh.validate("holed");
    for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face)
      for (int i = 0; i < 3; ++i)
        EXPECT_LE(
            (mesh.vertices.row(mesh.triangles(face, i)) - mesh.vertices.row(mesh.triangles(face, 0))).head<2>().norm(),
            1.5);
  }
  for (const StoredMesh& cloud : {parse_pcd("", kPcdHeader + vertices), parse_xyz("", vertices)})
    EXPECT_THAT(cloud.notes, ElementsAre(note + " were left out"));
}

TEST(StrangerFiles, MissesAtTheOriginAreToldAndStay) {
  Points missed = kSheet.vertices;
  for (const int row : {3, 9}) missed.row(row).setZero();
  const StoredMesh cloud = parse_pcd("", kPcdHeader + lines_of(missed));
  EXPECT_EQ(cloud.vertices, missed);
  EXPECT_THAT(cloud.notes, ElementsAre(HasSubstr("2 vertices are at exactly (0, 0, 0)")));
  missed.row(9) = kSheet.vertices.row(9);
  EXPECT_THAT(parse_pcd("", kPcdHeader + lines_of(missed)).notes, IsEmpty()) << "one is a place like any other";
}

TEST(StrangerObj, LinesGoOnBehindABackslash) {
  expect_sheet(parse_obj("", replaced(kObj, "f ", "f \\\n")));
  expect_sheet(parse_obj("", replaced(kObj, "f ", "f \\ \r\n  \\\n ")));
  expect_sheet(parse_obj("", "# from C:\\models\\\n" + kObj));
}

TEST(StrangerObj, CommentsMayStandBehind) {
  expect_sheet(parse_obj("", lines_of(kSheet.vertices, "v ", " # point\n") + face_lines("f", 1, "# face\n")));
}

TEST(StrangerObj, WhatIsNoPolygonIsSkippedAndCounted) {
  const StoredMesh mesh =
      parse_obj("", kObj + "vp 0 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2 \\\n3 4\nend\nvp 2 2\ng a\nusemtl b\n");
  EXPECT_EQ(mesh.triangles, kSheet.triangles);
  EXPECT_THAT(mesh.notes,
              ElementsAre("6 statements that are not supported were skipped: 'cstype', 'curv', 'deg', 'end', 'vp'"));
}

TEST(StrangerOff, TheKeywordMayTouchTheCounts) {
  expect_sheet(parse_off("", replaced(kOff, "OFF\n", "OFF")));
  EXPECT_THAT(complaint("", [] { parse_off("", "OFFICE 3 1\n"); }),
              HasSubstr("line 1: the number of vertices is 'ICE'"));
}

TEST(StrangerOff, CommentsAndBlankLinesMayStandAnywhere) {
  expect_sheet(parse_off("", "# made by hand\nOFF # comment\n\n# counts\n144 242 0 # v f e\n\n" +
                                 lines_of(kSheet.vertices, "", " # v\n\n") + face_lines("3", 0, " 255 0 0 # red\n")));
}

std::string compressed_pcd(const std::string& size_change = "", const std::string& damage = "") {
  std::string fields;
  for (int axis = 0; axis < 3; ++axis)
    for (Eigen::Index row = 0; row < 144; ++row) fields += encode({'f', kSheet.vertices(row, axis)}, false);
  std::string packed(fields.size() + 100, '\0');
  packed.resize(lzf_compress(fields.data(), static_cast<unsigned>(fields.size()), packed.data(),
                             static_cast<unsigned>(packed.size())));
  const auto size = [](std::size_t bytes) { return encode({'I', static_cast<double>(bytes)}, false); };
  return replaced(kPcdHeader, "ascii", "binary_compressed") + size(packed.size()) +
         (size_change.empty() ? size(fields.size()) : size_change) + damage + packed.substr(damage.size());
}

TEST(StrangerPcd, CompressedPointsAreRead) {
  const StoredMesh cloud = parse_pcd("", compressed_pcd());
  expect_cloud(cloud);
  EXPECT_THAT(cloud.notes, IsEmpty());
  EXPECT_THAT(parse_pcd("", compressed_pcd() + "abc").notes, ElementsAre(HasSubstr("3 bytes after the last point")));
}

TEST(StrangerPcd, CompressedSizesAreCheckedFirst) {
  const auto refusal = [](const std::string& content) { return complaint("", [&] { parse_pcd("", content); }); };
  const std::string whole = compressed_pcd();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
  EXPECT_THAT(refusal(compressed_pcd(encode({'I', 1727}, false))),
              HasSubstr("byte 4 after the header: promises 1727 bytes of points, expected 1728 as the header says"));
  EXPECT_THAT(refusal(compressed_pcd("", "\xff\xff\xff\xff")), HasSubstr("the compressed points are damaged"));
  const std::string bomb = replaced(replaced(kPcdHeader, "144", "100000000"), "ascii", "binary_compressed") +
                           encode({'I', 100}, false) + encode({'I', 1.2e9}, false) + std::string(100, '\xff');
  EXPECT_THAT(refusal(bomb), HasSubstr("promises 1200000000 bytes from 100 compressed ones, expected no more than 88"));
}

TEST(StrangerPcd, OldVersionsSayLess) {
  const std::string old =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 144\nHEIGHT 1\nPOINTS 144\nDATA ascii\n";
  const std::string points = lines_of(kSheet.vertices);
  expect_cloud(parse_pcd("", "# .PCD v.5\nVERSION .5\n" + old + points));
  expect_cloud(parse_pcd("", "# .PCD v.5\n" + old + points));
  expect_cloud(parse_pcd("", "COLUMNS x y z\nWIDTH 144\nDATA ascii\n" + points));
  EXPECT_THAT(complaint("", [&] { parse_pcd("", "VERSION 0.7\nCOLUMNS x y z\nWIDTH 144\nDATA ascii\n" + points); }),
              HasSubstr("line 2: found 'COLUMNS x y z', expected the entry FIELDS"));
}

TEST(StrangerPcd, TheViewpointIsTheSensor) {
  EXPECT_FALSE(parse_pcd("", kPcd).sensor);
  const StoredMesh cloud =
      parse_pcd("", replaced(kPcd, "VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 10 0 -2 0.7071 0 0 0.7071"));
  ASSERT_TRUE(cloud.sensor);
  EXPECT_EQ(*cloud.sensor, Eigen::Vector3d(10, 0, -2));
  EXPECT_EQ(cloud.vertices, kSheet.vertices) << "it is not applied";
  const StoredMesh turned = parse_pcd("", replaced(kPcd, "VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0 0 0 0 1 0 0"));
  ASSERT_TRUE(turned.sensor) << "a turned sensor at the origin is none by default";
  EXPECT_EQ(*turned.sensor, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace corral
