// SPDX-License-Identifier: MIT
// Normals that mesh files bring.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/mesh/mesh_file.h"
#include "tests/io/mesh/pcd_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kVertices = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

Points rows(std::initializer_list<Eigen::RowVector3d> each) {
  Points points(static_cast<Eigen::Index>(each.size()), 3);
  Eigen::Index row = 0;
  for (const Eigen::RowVector3d& point : each) points.row(row++) = point;
  return points;
}

TEST(StoredNormals, Ply) {
  for (const std::string& format : testing::kPlyFormats) {
    const auto file = [&](const std::string& last, double bad) {
      return testing::ply_file(
          format,
          "element vertex 2\nproperty float nx\nproperty float ny\nproperty double x\nproperty double y\n"
          "property double z\nproperty float " +
              last + "\n",
          {{{'f', 0}, {'f', 3}, {'d', 1}, {'d', 2}, {'d', 3}, {'f', 4}},
           {{'f', 1}, {'f', bad}, {'d', 4}, {'d', 5}, {'d', 6}, {'f', 0}}});
    };
    const StoredMesh mesh = parse_ply("", file("nz", 0));
    EXPECT_EQ(mesh.normals, rows({{0, 3, 4}, {1, 0, 0}}));
    EXPECT_EQ(mesh.vertices, rows({{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(parse_ply("", file("curvature", 0)).normals.rows(), 0) << "two components are no normal";
    const StoredMesh unknown = parse_ply("", file("nz", std::nan("")));
    EXPECT_EQ(unknown.normals, rows({{0, 3, 4}, {0, 0, 0}}));
    EXPECT_THAT(unknown.notes, ElementsAre("1 normal is not finite: taken as unknown"));
  }
}

TEST(StoredNormals, PcdInBothEncodings) {
  testing::PcdEntries entries;
  entries.fields = "x y z normal_x normal_y normal_z curvature";
  entries.sizes = "4 4 4 4 4 4 4";
  entries.types = "F F F F F F F";
  entries.counts = "1 1 1 1 1 1 1";
  entries.width = entries.points = "2";
  for (const bool binary : {false, true}) {
    const auto file = [&](double nx, double ny) {
      return testing::pcd_file(binary, entries.text(),
                               {{{'f', 1}, {'f', 2}, {'f', 3}, {'f', 0}, {'f', ny}, {'f', 0}, {'f', 9}},
                                {{'f', 4}, {'f', 5}, {'f', 6}, {'f', nx}, {'f', 0}, {'f', 0}, {'f', 9}}});
    };
    EXPECT_EQ(parse_pcd("", file(-1, 1)).normals, rows({{0, 1, 0}, {-1, 0, 0}}));
    EXPECT_EQ(parse_pcd("", file(std::nan(""), std::nan(""))).normals.rows(), 0) << "none is known";
  }
}

TEST(StoredNormals, OffByTheOrderOfItsKeyword) {
  const auto normals = [](const std::string& text) { return parse_off("", text).normals; };
  EXPECT_EQ(normals("NOFF\n1 0 0\n1 2 3 0 0 1\n"), rows({{0, 0, 1}}));
  EXPECT_EQ(normals("STCNOFF\n1 0 0\n1 2 3 0 0 1 255 0 0 255 0.5 0.5\n"), rows({{0, 0, 1}})) << "Geomview's order";
  EXPECT_EQ(normals("NCOFF\n1 0 0\n1 2 3 255 0 0 255 0 0 1\n"), rows({{0, 0, 1}})) << "MeshLab's order";
  EXPECT_EQ(normals("COFF\n1 0 0\n1 2 3 255 0 0 255\n").rows(), 0);
  EXPECT_THAT(complaint("", [] { parse_off("", "NOFF\n1 0 0\n1 2 3 0 0\n"); }),
              HasSubstr("line 3: found 5 fields, expected three coordinates and a normal"));
  EXPECT_THAT(complaint("", [] { parse_off("", "4OFF\n1 0 0\n1 2 3 1\n"); }), HasSubstr("line 1: found '4OFF'"));
}

TEST(StoredNormals, ObjByVertex) {
  const StoredMesh mesh = parse_obj("", kVertices + "vn 0 0 2\nvn 1 0 0\nf 1//1 2//2 3/7/-1\nf 1//1 3//2 4\n");
  EXPECT_EQ(mesh.normals, rows({{0, 0, 2}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}}));
  EXPECT_THAT(mesh.notes, IsEmpty());
}

TEST(StoredNormals, ObjOfSeveralIsTheDirectionOfTheirSum) {
  const StoredMesh mesh = parse_obj(
      "", kVertices + "vn 0 0 2\nvn 3 0 0\nvn -1 0 0\nf 1//1 2//2 3//1\nf 1//2 2//3 3//1\nf 1//1 3//1 4//1\n");
  EXPECT_TRUE(mesh.normals.row(0).isApprox(Eigen::RowVector3d(1, 0, 1).normalized()));
  EXPECT_TRUE(mesh.normals.row(1).isZero(0)) << "against each other";
  EXPECT_EQ(mesh.normals.row(2), Eigen::RowVector3d(0, 0, 2));
}

TEST(StoredNormals, ObjOfACloud) {
  EXPECT_EQ(parse_obj("", "vn 0 0 1\nv 1 2 3\nvn 0 1 0\nv 4 5 6\n").normals, rows({{0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(parse_obj("", "vn 0 0 1\nv 1 2 3\nv 4 5 6\n").normals.rows(), 0);
  EXPECT_EQ(parse_obj("", "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nv 1 2 3\nv 4 5 6\nv 4 7 8\nf 1 2 3\n").normals.rows(), 0);
}

TEST(StoredNormals, ObjThatAreNotThereAreCounted) {
  const StoredMesh mesh = parse_obj("", kVertices + "f 1//1 2//-1 3//x\n");
  EXPECT_EQ(mesh.normals.rows(), 0);
  EXPECT_THAT(mesh.notes, ElementsAre("3 corners name normals that the file does not have"));
}

TEST(StoredNormals, MissingVerticesTakeTheirsAlong) {
  const StoredMesh mesh = parse_off("", "NOFF\n3 0 0\n1 2 3 0 0 1\nnan 0 0 0 1 0\n4 5 6 1 0 0\n");
  EXPECT_EQ(mesh.vertices, rows({{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(mesh.normals, rows({{0, 0, 1}, {1, 0, 0}}));
}

}  // namespace
}  // namespace corral
