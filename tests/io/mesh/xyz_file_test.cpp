// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/mesh/mesh_file.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::replaced;

const std::string kPath = "folder/cloud.xyz";
const std::string kCloud = "0.5 -1 2e3\n1 2 3\n-0.25 +0.125 4\n";

std::string refusal(const std::string& content) {
  return complaint(kPath, [&] { parse_xyz(kPath, content); });
}

void expect_cloud(const Mesh& mesh) {
  Points vertices(3, 3);
  vertices << 0.5, -1, 2000, 1, 2, 3, -0.25, 0.125, 4;
  EXPECT_EQ(mesh.vertices, vertices);
  EXPECT_EQ(mesh.triangles.rows(), 0);
}

TEST(XyzFile, ReadsPoints) {
  expect_cloud(parse_xyz(kPath, kCloud));
  const testing::ScratchFolder folder;
  expect_cloud(read_mesh(testing::put_text(folder / "a.XYZ", kCloud)));
}

TEST(XyzFile, AcceptsItsVariants) {
  expect_cloud(parse_xyz(kPath, replaced(kCloud, "\n", "\r\n")));
  expect_cloud(parse_xyz(kPath, replaced(kCloud, " ", "\t  ")));
  expect_cloud(parse_xyz(kPath, replaced(kCloud, " ", ",")));
  expect_cloud(parse_xyz(kPath, replaced(kCloud, " ", " , ")));
  expect_cloud(parse_xyz(kPath, "# x y z\n\n" + replaced(kCloud, "\n1", "\n # between\n\n1") + "\n"));
}

TEST(XyzFile, ColumnsAfterTheThirdAreNotRead) {
  expect_cloud(parse_xyz(kPath, replaced(kCloud, "\n", " 255 0 0\n")));
  expect_cloud(parse_xyz(kPath, replaced(kCloud, "\n", " nan label\n")));
  expect_cloud(parse_xyz(kPath, replaced(replaced(kCloud, " ", ","), "\n", ",a b,\n")));
}

TEST(XyzFile, AllLinesHaveTheSameColumns) {
  EXPECT_EQ(refusal(replaced(kCloud, "1 2 3", "1 2 3 4")), ", line 2: found 4 columns, expected 3 as in line 1");
  EXPECT_EQ(refusal("# r g b too\n" + replaced(replaced(kCloud, "\n", " 1 2 3\n"), "1 2 3 1 2 3", "1 2 3 1 2")),
            ", line 3: found 5 columns, expected 6 as in line 2");
}

TEST(XyzFile, NamesTheLineOfWhatIsNoPoint) {
  EXPECT_EQ(refusal("1 2\n"), ", line 1: found '1 2', expected at least the three coordinates of a point");
  EXPECT_EQ(refusal("1\n\nC 0 0 0\n"), ", line 3: found 'C', expected a number");
  EXPECT_EQ(refusal("x 1 z\n" + kCloud), ", line 1: found 'x', expected a number");
  for (const char* bad : {"inf", "-inf"})
    EXPECT_EQ(refusal(replaced(kCloud, "1 2 3", "1 2 " + std::string(bad))),
              ", line 2: found '" + std::string(bad) + "', expected a finite number");
  for (const char* bad : {"1e999", "x", "1:", "0x1"})
    EXPECT_EQ(refusal(replaced(kCloud, "1 2 3", "1 " + std::string(bad) + " 3")),
              ", line 2: found '" + std::string(bad) + "', expected a number");
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("no point, expected lines like '0 0 0'"));
}

// Read with a point as decimal mark these would be other numbers.
TEST(XyzFile, DecimalCommasAreErrors) {
  EXPECT_EQ(refusal("1,5 2,5 3,5\n"), ", line 1: found '5 2', expected a number");
  EXPECT_EQ(refusal("1,5;2,5;3,5\n"), ", line 1: found '1,5', expected a number");
  EXPECT_EQ(refusal("1 2 3,5\n"), ", line 1: found '1 2 3,5', expected at least the three coordinates of a point");
  EXPECT_EQ(refusal("1,,3\n"), ", line 1: found '', expected a number");
}

TEST(XyzFile, ALineOfNamesMayStandInFront) {
  for (const char* names : {"x y z\n", "X,Y,Z\n", "//X Y Z\n", "// x y z\n", "\"x\";\"y\";\"z\"\n",
                            "east north height\n", "Points:0,Points:1,Points:2\n"})
    expect_cloud(parse_xyz(kPath, names + kCloud));
  const std::string coloured = replaced(replaced(kCloud, "\n", ";red\n"), " ", ";");
  expect_cloud(parse_xyz(kPath, "x;y;z;colour\n" + coloured));
  Points turned(1, 3);
  turned << 4, 3, 2;
  EXPECT_EQ(parse_xyz(kPath, "id,Z,Y,X,intensity\n1,2,3,4,5\n").vertices, turned);
  EXPECT_EQ(refusal("id,Y,X\n1,2,3\n"), ", line 1: found 'id,Y,X', expected columns named x, y and z");
  EXPECT_EQ(refusal("id,w,X,Y,Z\n1,2,3\n"),
            ", line 2: found '1,2,3', expected at least the three coordinates of a point");
  EXPECT_THAT(refusal("x y z\n"), HasSubstr("no point, expected"));
}

TEST(XyzFile, NormalsAreReadWhereTheNamesSayWhere) {
  const std::string cloud = "0 0 0 9 0 0 1\n1 2 3 9 0.6 0.8 0\n";
  Points normals(2, 3);
  normals << 0, 0, 1, 0.6, 0.8, 0;
  EXPECT_EQ(parse_xyz(kPath, "//X Y Z Intensity Nx Ny Nz\n" + cloud).normals, normals);
  EXPECT_EQ(parse_xyz(kPath, "x y z i Normals:0 Normals:1 Normals:2\n" + cloud).normals, normals);
  EXPECT_EQ(parse_xyz(kPath, "//X Y Z Intensity Nx Ny Cz\n" + cloud).normals.rows(), 0);
  EXPECT_EQ(parse_xyz(kPath, cloud).normals.rows(), 0);
  EXPECT_EQ(refusal("x y z nx ny nz\n1 2 3\n"), ", line 2: found '1 2 3', expected a normal as the names say");
  EXPECT_EQ(refusal("x y z nx ny nz\n1 2 3 0 a 1\n"), ", line 2: found 'a', expected a number");
}

TEST(XyzFile, AColumnThatCountsThePointsIsNotX) {
  const std::string counted = "0,0.5,-1,2e3\n1,1,2,3\n2,-0.25,0.125,4\n";
  for (const char* names : {",x,y,z\n", "\"\",\"x\",\"y\",\"z\"\n", "id,x,y,z\n", ",east,north,height\n",
                            "Index,E,N,H\n", "Unnamed: 0,a,b,c\n"})
    expect_cloud(parse_xyz(kPath, names + counted));
  EXPECT_THAT(parse_xyz(kPath, "Index,E,N,H\n" + counted).notes,
              ElementsAre("the columns named 'e', 'n' and 'h' are read as x, y and z"));
  EXPECT_EQ(refusal("id,east,north\n1,2,3\n"), ", line 1: found 'id,east,north', expected columns named x, y and z");
  // So R writes the names of rows.
  EXPECT_EQ(refusal("x y z\n" + replaced(counted, ",", " ")),
            ", line 2: found 4 columns, expected 3 as there are names: which of them has none is not known");
}

TEST(XyzFile, AnEmptyCellBelowNamesIsAMissingNumber) {
  const StoredMesh cloud = parse_xyz(kPath, "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4,,6,0,0,1\n7,8,9,0,,1\n");
  EXPECT_EQ(cloud.vertices.rows(), 2);
  EXPECT_EQ(cloud.normals.row(0), Eigen::RowVector3d(0, 0, 1));
  EXPECT_EQ(cloud.normals.row(1), Eigen::RowVector3d(0, 0, 0));
  EXPECT_THAT(cloud.notes, ::testing::Contains("1 vertex with a nan coordinate was left out"));
  EXPECT_EQ(refusal("1,2,3\n4,,6\n"), ", line 2: found '', expected a number");
}

TEST(XyzFile, ALineWithTheNumberOfPointsIsChecked) {
  expect_cloud(parse_xyz(kPath, "3\n" + kCloud));
  expect_cloud(parse_xyz(kPath, "//X Y Z\n3\n" + kCloud));
  EXPECT_THAT(parse_xyz(kPath, "3\n" + kCloud.substr(0, kCloud.size() - 1)).notes,
              ElementsAre(HasSubstr("lacks its newline")));
  const StoredMesh two = parse_xyz(kPath, "2\n" + kCloud);
  EXPECT_EQ(two.vertices.rows(), 2);
  EXPECT_THAT(two.notes, ElementsAre("15 bytes after the last point that the file promises were not read"));
  EXPECT_EQ(refusal("4\n" + kCloud), ", line 5: the file ends here, expected point 3 of 4");
  EXPECT_EQ(refusal("2000000000\n" + kCloud),
            ", line 1: the file promises 2000000000 points, but only 32 bytes follow");
  EXPECT_THAT(refusal("0\n" + kCloud), HasSubstr(", line 1: the number of points is '0', expected"));
}

TEST(XyzFile, MissingPointsAreLeftOut) {
  const StoredMesh cloud = parse_xyz(kPath, replaced(kCloud, "1 2 3", "1 nan 3"));
  EXPECT_EQ(cloud.vertices.rows(), 2);
  EXPECT_THAT(cloud.notes, ElementsAre("1 vertex with a nan coordinate was left out"));
}

// The format has no counts: a cut at the end of a line leaves a smaller, valid cloud.
TEST(XyzFile, TruncationAtEveryOtherByteIsAnError) {
  for (std::size_t length = 0; length < kCloud.size(); ++length) {
    const bool between_lines = length > 0 && kCloud[length - 1] == '\n';
    EXPECT_EQ(refusal(kCloud.substr(0, length)).empty(), between_lines) << "cut at byte " << length;
  }
}

}  // namespace
}  // namespace corral
