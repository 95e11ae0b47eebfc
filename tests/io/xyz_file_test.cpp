// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/mesh_file.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::complaint;
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
  EXPECT_EQ(refusal("3\n\nC 0 0 0\n"), ", line 1: found '3', expected at least the three coordinates of a point");
  EXPECT_EQ(refusal("x y z\n" + kCloud), ", line 1: found 'x', expected a number");
  for (const char* bad : {"nan", "inf", "-inf"})
    EXPECT_EQ(refusal(replaced(kCloud, "1 2 3", "1 2 " + std::string(bad))),
              ", line 2: found '" + std::string(bad) + "', expected a finite number");
  for (const char* bad : {"1e999", "x", "1;", "0x1"})
    EXPECT_EQ(refusal(replaced(kCloud, "1 2 3", "1 " + std::string(bad) + " 3")),
              ", line 2: found '" + std::string(bad) + "', expected a number");
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("no point, expected lines like '0 0 0'"));
}

// Read with a point as decimal mark these would be other numbers.
TEST(XyzFile, DecimalCommasAreErrors) {
  EXPECT_EQ(refusal("1,5 2,5 3,5\n"), ", line 1: found '5 2', expected a number");
  EXPECT_EQ(refusal("1,5;2,5;3,5\n"), ", line 1: found '5;2', expected a number");
  EXPECT_EQ(refusal("1 2 3,5\n"), ", line 1: found '1 2 3,5', expected at least the three coordinates of a point");
  EXPECT_EQ(refusal("1,,3\n"), ", line 1: found '', expected a number");
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
