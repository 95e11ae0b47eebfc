// SPDX-License-Identifier: MIT
// Every layout of the field that a pose may be stored in, and the rules for rounded rotations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <string>

#include "io/pose/transform_file.h"
#include "kernel/number_text.h"
#include "kernel/random.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;
using testing::put_text;
using testing::replaced;
using testing::ScratchFolder;

const ScratchFolder& folder() {
  static const ScratchFolder folder;
  return folder;
}

StoredTransform read_as(const std::string& file, const std::string& text, const std::string& key = "") {
  return read_transform(put_text(folder() / file, text) + (key.empty() ? "" : ":" + key));
}
StoredTransform read_text(const std::string& text, const std::string& key = "") {
  return read_as("pose.txt", text, key);
}
std::string refusal(const std::string& text, const std::string& key = "") {
  return io_error_of([&] { read_text(text, key); });
}

RigidTransform random_pose(RandomStream& random) { return {random.rotation(), 100 * random.direction()}; }

void expect_near(const RigidTransform& read, const RigidTransform& expected, double tolerance = 1e-12) {
  EXPECT_LE((read.rotation - expected.rotation).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LE((read.translation - expected.translation).cwiseAbs().maxCoeff(),
            tolerance * (1 + expected.translation.norm()));
}

/// The rows of the 4x4 matrix with this between numbers and between rows.
std::string matrix(const RigidTransform& pose, const std::string& comma, const std::string& row_end, int rows = 4) {
  std::string text;
  for (int row = 0; row < rows; ++row) {
    text += row > 0 ? row_end : "";
    for (int column = 0; column < 4; ++column) {
      const double number = row == 3      ? (column == 3 ? 1 : 0)
                            : column == 3 ? pose.translation(row)
                                          : pose.rotation(row, column);
      text += (column > 0 ? comma : "") + to_text(number);
    }
  }
  return text;
}

std::string printed(const Eigen::Matrix3d& rotation, int digits) {
  std::string text;
  char buffer[40];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      std::snprintf(buffer, sizeof buffer, "%.*f ", digits, column < 3 ? rotation(row, column) : row + 1.0);
      text += buffer + std::string(column < 3 ? "" : "\n");
    }
  return text + "0 0 0 1\n";
}

TEST(PoseLayouts, MatricesWithAllThatProgramsPrintAroundThem) {
  RandomStream random(1);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform pose = random_pose(random);
    for (const int rows : {3, 4}) {
      const auto text = [&](const std::string& comma, const std::string& end) {
        return matrix(pose, comma, end, rows);
      };
      for (const std::string& written :
           {text(" ", "\n") + "\n", text(" ", " ") + "\n", text(", ", "\n") + "\n", text(",", ",\n") + "\n",
            text("\t", ";\n") + ";\n", text("; ", "\n") + "\n", "[" + text(" ", "; ") + "]\n",
            "T = [" + text(", ", ";\n  ") + "];\n", "T =\n\n   " + text("   ", "\n   ") + "\n\n",
            "[[" + text(" ", "]\n [") + "]]\n", "[[" + text(", ", "], [") + "]]",
            "array([[" + text(", ", "],\n       [") + "]])\n",
            "pose_1 = np.array([[" + text(", ", "], [") + "]], dtype=float32)\n", "[" + text(", ", ",\n") + "]\n",
            "{{" + text(", ", "},\n {") + "}}\n", "% from MATLAB\n" + text(" ", "\n") + "\n",
            "\xEF\xBB\xBF" + text(" ", "\r\n") + "\r\n"}) {
        SCOPED_TRACE(written);
        const StoredTransform read = read_text(written);
        EXPECT_EQ(read.rotation, pose.rotation);
        EXPECT_EQ(read.translation, pose.translation);
        EXPECT_THAT(read.notes, IsEmpty());
      }
    }
  }
}

TEST(PoseLayouts, WhatIsWrittenReadsBack) {
  RandomStream random(2);
  const struct {
    TransformLayout layout;
    std::string key, read_key;
  } cases[] = {{TransformLayout::Matrix4x4, "", ""}, {TransformLayout::Matrix3x4, "", ""},
               {TransformLayout::Kitti, "", ""},     {TransformLayout::Kitti, "", "0"},
               {TransformLayout::Tum, "", ""},       {TransformLayout::Tum, "1305031102.1753", "1305031102.17530"},
               {TransformLayout::Log, "", "1,0"},    {TransformLayout::Log, "7,12", "7,12"},
               {TransformLayout::Conf, "", ""},      {TransformLayout::Conf, "bun045.ply", "bun045.ply"},
               {TransformLayout::JsonRows, "", ""},  {TransformLayout::Bop, "", ""},
               {TransformLayout::Bop, "3", "3/0"}};
  for (const auto& each : cases)
    for (int i = 0; i < 20; ++i) {
      const RigidTransform pose = random_pose(random);
      const std::string text = transform_text(pose, each.layout, each.key);
      SCOPED_TRACE(text);
      const StoredTransform read = read_text(text, each.read_key);
      expect_near(read, pose);
      EXPECT_THAT(read.notes, IsEmpty());
      if (each.layout == TransformLayout::Tum || each.layout == TransformLayout::Conf) continue;
      EXPECT_EQ(read.rotation, pose.rotation);
      EXPECT_EQ(read.translation, pose.translation);
    }
}

TEST(PoseLayouts, KeysThatALayoutCannotHoldAreRefused) {
  const std::pair<TransformLayout, const char*> cases[] = {
      {TransformLayout::Matrix4x4, "1"}, {TransformLayout::Kitti, "1"},      {TransformLayout::Tum, "now"},
      {TransformLayout::Tum, "inf"},     {TransformLayout::Log, "1"},        {TransformLayout::Log, "1,1"},
      {TransformLayout::Log, "1,x"},     {TransformLayout::Log, "-1,0"},     {TransformLayout::Conf, "a b.ply"},
      {TransformLayout::Bop, "3/0"},     {TransformLayout::JsonRows, "name"}};
  for (const auto& [layout, key] : cases) EXPECT_THROW(transform_text({}, layout, key), InvalidInput) << key;
}

TEST(PoseLayouts, QuaternionsAreOfUnitLength) {
  const RigidTransform turn{Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {1, 2, 3}};
  expect_near(read_text("1.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n"), turn);
  expect_near(read_text("# time tx ty tz qx qy qz qw\n1.5,1,2,3,0,0,-0.70710678118654,-0.70710678118654\n"), turn);
  const StoredTransform rounded = read_text("1.5 1 2 3 0 0 0.707 0.708\n");
  expect_near(rounded, turn, 2e-3);
  EXPECT_NEAR(rounded.rotation.determinant(), 1, 1e-12);
  EXPECT_THAT(rounded.notes, ElementsAre(HasSubstr("the quaternion is printed with 3 digits: normalised from 1.00")));
  EXPECT_THAT(refusal("1.5 1 2 3 0 0 0.7071 0.7171\n"),
              EndsWith("pose.txt, quaternion: has the length 1.00709, expected 1 within 0.0001"));
  EXPECT_THAT(refusal("1.5 1 2 3 0 0 0 0\n"), HasSubstr("quaternion: has the length 0, expected 1"));
  EXPECT_THAT(refusal("1.5 1 2 3 0 0 1e200 1e200\n"), HasSubstr("quaternion: has the length"));
}

// One row alone would be read the other way.
TEST(PoseLayouts, RowsOfSevenNumbersHaveOneOrder) {
  const std::string rows = "0.6 0 0 0.8 1 2 3\n1 0 0 0 1 0 0\n0.8 0.6 0 0 5 5 5\n";
  const StoredTransform pose = read_text(rows, "1");
  EXPECT_TRUE(pose.rotation.isIdentity(1e-12));
  EXPECT_EQ(pose.translation, Eigen::Vector3d(1, 0, 0));
  EXPECT_THAT(pose.notes, ElementsAre("7 numbers are read as a quaternion w x y z and a translation"));
}

TEST(PoseLayouts, SevenNumbersAreReadByTheirUnitLengthAndItIsSaid) {
  const RigidTransform turn{Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {1, 2, 3}};
  const StoredTransform last = read_text("1 2 3 0 0 0.70710678 0.70710678\n"),
                        first = read_text("0.70710678 0 0 0.70710678 1 2 3\n");
  expect_near(last, turn, 1e-8);
  expect_near(first, turn, 1e-8);
  EXPECT_THAT(last.notes, ElementsAre("7 numbers are read as a translation and a quaternion x y z w"));
  EXPECT_THAT(first.notes, ElementsAre("7 numbers are read as a quaternion w x y z and a translation"));
  EXPECT_THAT(refusal("1 2 3 1 2 3 4\n"), HasSubstr("quaternion: has the length 5.47723"));
}

TEST(PoseLayouts, FramesOfATrajectoryAreMappedIntoTheWorldOrIntoEachOther) {
  RandomStream random(3);
  std::string kitti, tum, bare, log;
  std::vector<RigidTransform> world;
  for (int i = 0; i < 6; ++i) {
    world.push_back(random_pose(random));
    const std::string seven = transform_text(world.back(), TransformLayout::Tum).substr(2);
    kitti += matrix(world.back(), " ", " ", 3) + "\n";
    tum += std::to_string(1000 + i) + ".25 " + seven;
    bare += seven;
    log +=
        std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i + 1) + "\n" + transform_text(world.back());
  }
  const RigidTransform relative = world[4].inverse() * world[1];
  for (const std::string& text : {kitti, bare, log}) {
    expect_near(read_text(text, "4"), world[4], 1e-9);
    expect_near(read_text(text, "1,4"), relative, 1e-9);
    EXPECT_THAT(refusal(text),
                HasSubstr("has 6 poses, expected FILE:KEY, which names one of '0', '1', '2', '3', '4', ... '5'"));
    EXPECT_THAT(refusal(text, "6"), HasSubstr("pose 6: is not there, expected one of '0', '1'"));
    EXPECT_THAT(refusal(text, "1,6"), HasSubstr("pose 1,6: is not there"));
    for (const char* bad : {"x", "-1", ",", "1,", ",1", "1,2,3", "1;4"}) EXPECT_NE(refusal(text, bad), "") << bad;
  }
  expect_near(read_text(tum, "1001.25,1004.250"), relative, 1e-9);
  EXPECT_THAT(refusal(tum, "1"), HasSubstr("expected one of '1000.25', '1001.25'"));
  EXPECT_THAT(refusal(tum + tum, "1001.25"), HasSubstr("line 8: the pose 1001.25 is there twice"));
  EXPECT_THAT(read_text(bare, "1,4").notes, ElementsAre(HasSubstr("7 numbers"))) << "a note is said once";
}

TEST(PoseLayouts, OnlyThePoseThatIsNamedHasToBeRigid) {
  const std::string good = "1 0 0 1 0 1 0 2 0 0 1 3\n", bad = "2 0 0 1 0 2 0 2 0 0 2 3\n";
  EXPECT_EQ(read_text(good + bad, "0").translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(refusal(good + bad, "1"), HasSubstr("pose.txt, line 2, rotation: not rigid"));
  EXPECT_THAT(refusal(good + bad, "0,1"), HasSubstr("line 2, rotation: not rigid"));
}

TEST(PoseLayouts, ALogNamesThePairAndMapsTheSecondFragmentIntoTheFirst) {
  RandomStream random(4);
  const RigidTransform first = random_pose(random), second = random_pose(random);
  const std::string log = "0\t 3\t 12\n" + transform_text(first) + "2 3 12\n" + transform_text(second);
  for (const char* name : {"gt.log", "gt.txt"}) {
    const StoredTransform stored = read_as(name, log, "3,0"), inverse = read_as(name, log, "0,3");
    EXPECT_EQ(stored.rotation, first.rotation) << "from 3 into 0, as it is stored";
    EXPECT_THAT(stored.notes, IsEmpty());
    expect_near(inverse, first.inverse());
    EXPECT_THAT(inverse.notes, ElementsAre("it is the inverse of the stored pose, which maps 3 into 0"));
    EXPECT_EQ(read_as(name, log, "3,2").rotation, second.rotation);
  }
  EXPECT_EQ(read_text("0 1 2\n" + transform_text(first)).rotation, first.rotation) << "the only one needs no key";
  EXPECT_THAT(refusal(log), HasSubstr("has 2 poses, expected FILE:KEY, which names one of '3,0', '3,2'"));
  EXPECT_THAT(refusal(log, "3"), HasSubstr("pose 3: is not there"));
  EXPECT_THAT(refusal(log, "0,2"), HasSubstr("pose 0,2: is not there, expected one of '3,0', '3,2'"));
  EXPECT_THAT(refusal(log + log, "3,0"), HasSubstr("line 11: the pose 3,0 is there twice"));
  EXPECT_THAT(refusal(log + "2 4\n"), HasSubstr("line 11: has 2 numbers, expected two fragments and their count"));
  EXPECT_THAT(refusal(log + "2 4 12\n1 0 0 0\n"),
              HasSubstr("line 12: the file ends after it, expected a row of a 4x4"));
  EXPECT_THAT(refusal(log + "2 4 12\n1 0 0\n"), HasSubstr("line 12: has 3 numbers, expected a row of a 4x4 matrix"));
  EXPECT_THAT(refusal(replaced(log, "2 3 12", "2 3.5 12")), HasSubstr("line 6: found 3.5 as a fragment"));
}

TEST(PoseLayouts, TheQuaternionOfAConfIsTheTransposes) {
  // Of the published bunny; the matrix is R(q)^T with the translation as it stands.
  const std::string conf =
      "camera -0.0172 -0.0936 -0.734  -0.0461723 0.970603 -0.235889 0.0124573\n"
      "bmesh bun000.ply 0 0 0 0 0 0 1\n"
      "bmesh bun045.ply -0.0520211 -0.000383981 -0.0109223 0.00548449 -0.294635 -0.0038555 0.955586\n\n";
  RigidTransform world;
  world.rotation << 0.826350588, -0.0106003762, 0.563056248, 0.00413668099, 0.999910111, 0.0127537427, -0.56314083,
      -0.00820987873, 0.826320158;
  world.translation << -0.0520211, -0.000383981, -0.0109223;
  for (const char* name : {"bun.conf", "bun.txt"}) {
    expect_near(read_as(name, conf, "bun045.ply"), world, 1e-6);
    expect_near(read_as(name, conf, "bun045.ply,bun000.ply"), world, 1e-6);
    expect_near(read_as(name, conf, "bun000.ply,bun045.ply"), world.inverse(), 1e-6);
  }
  EXPECT_THAT(refusal(conf, "bun45.ply"), HasSubstr("did you mean 'bun045.ply'?"));
  EXPECT_THAT(refusal(conf + "bmesh a.ply 0 0 0 0 0 1\n"), HasSubstr("line 5: has 8 fields, expected bmesh FILE tx"));
  EXPECT_THAT(refusal(conf + "scan a.ply 0 0 0 0 0 0 1\n"), HasSubstr("line 5: found 'scan', expected bmesh, mesh or"));
  EXPECT_THAT(refusal(conf + "bmesh a.ply 0 0 0 0 0 x 1\n"), HasSubstr("line 5: found 'x', expected a number"));
  EXPECT_THAT(refusal(conf + "bmesh a.ply 0 0 0 0 0 1 1\n", "a.ply"), HasSubstr("line 5, quaternion: has the length"));
}

TEST(PoseLayouts, BopNamesTheInstanceOfAnImage) {
  const std::string bop =
      R"({"3": [{"cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [1, 2, 3], "obj_id": 5},
                {"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [1, 2.5, 700], "obj_id": 8}],
          "17": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 2], "cam_t_m2c": [1, 2, 3], "obj_id": 5}]})";
  const StoredTransform first = read_as("scene_gt.json", bop, "3/0"), second = read_as("scene_gt.json", bop, "3/1");
  EXPECT_EQ(first * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 3, 3));
  EXPECT_EQ(second.translation, Eigen::Vector3d(1, 2.5, 700));
  expect_near(read_text(bop, "3/0,3/1"), second.inverse() * first);
  EXPECT_THAT(refusal(bop), HasSubstr("has 3 poses, expected FILE:KEY, which names one of '17/0', '3/0', '3/1'"));
  EXPECT_THAT(refusal(bop, "17/0"), HasSubstr("pose.txt, 17/0, rotation: not rigid"));
  EXPECT_THAT(refusal(bop, "3/0,17/0"), HasSubstr("cameras of two images"));
  EXPECT_THAT(refusal(bop, "3/2"), HasSubstr("pose 3/2: is not there"));
  EXPECT_THAT(refusal(replaced(bop, "cam_t_m2c", "t"), "3/0"), HasSubstr("pose.txt, 17/0: has no cam_t_m2c"));
  EXPECT_THAT(refusal(replaced(bop, "700]", "700, 1]"), "3/0"),
              HasSubstr("3/1: cam_t_m2c: expected an array of 3 numbers"));
  EXPECT_THAT(refusal(replaced(bop, "2.5", "\"x\""), "3/0"), HasSubstr("3/1: cam_t_m2c: expected an array of 3"));
}

TEST(PoseLayouts, JsonHoldsMatricesByName) {
  const std::string json =
      R"({"matches": 7, "target_from_source": [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]})";
  EXPECT_EQ(read_text(json).translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read_text(json, "target_from_source").translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(refusal(json, "matches"), HasSubstr("pose matches: is not there"));
}

TEST(PoseLayouts, HostileJsonIsRefused) {
  EXPECT_THAT(refusal("{}"), HasSubstr("has no pose"));
  EXPECT_THAT(refusal("{\"a\": "), AllOf(HasSubstr("pose.txt, byte "), HasSubstr("is not valid JSON")));
  std::string members = "{", empties = "{\"a\": [";
  for (int i = 0; i < 300000; ++i) members += "\"" + std::to_string(i) + "\":0,", empties += "{},";
  EXPECT_THAT(refusal(members + "\"x\":0}"), HasSubstr("has no pose"));
  EXPECT_THAT(refusal(empties + "{}]}"), HasSubstr("has no pose"));
  EXPECT_THAT(refusal("{\"a\": [1e999]}"), HasSubstr("too large"));
  EXPECT_THAT(refusal("{\"a\": [[[[1]]]], \"b\": null, \"c\": {}}"), HasSubstr("has no pose"));
  EXPECT_THAT(refusal("{\"3\": [{\"cam_R_m2c\": 1}], \"4\": 5}"), HasSubstr("3/0: cam_R_m2c: expected an array of 9"));
  EXPECT_THAT(refusal("{\"3\": [{\"cam_R_m2c\": 1}, 5]}"), HasSubstr("3/0"));
  EXPECT_THAT(refusal("{\"a\": " + std::string(1000000, '[')), HasSubstr("nested more than 50 deep"));
  std::string objects = "{\"a\":";
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_THAT(refusal(objects), HasSubstr("nested more than 50 deep"));
  EXPECT_THAT(refusal(std::string(1000000, '[')), HasSubstr("found 0 numbers"));
  std::string many = "{\"a\": [0";
  for (int i = 0; i < 300000; ++i) many += ",0";
  EXPECT_THAT(refusal(many + "]}"), HasSubstr("has no pose"));
}

// Half a unit in the last place of every entry is forgiven, no more.
TEST(PoseLayouts, RotationsPrintedWithThreeOrFourDigitsAreTakenToTheNearest) {
  RandomStream random(5);
  int noted = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d rotation = random.rotation();
    for (const int digits : {3, 4, 5, 9}) {
      const StoredTransform read = read_text(printed(rotation, digits));
      EXPECT_LE((read.rotation - rotation).norm(), 3 * std::pow(10, -digits));
      if (read.notes.empty()) continue;
      EXPECT_LE(digits, 4);
      EXPECT_NEAR((read.rotation * read.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
      EXPECT_THAT(read.notes, ElementsAre(AllOf(HasSubstr("printed with " + std::to_string(digits) + " digits: taken"),
                                                HasSubstr("change by at most 0.000"))));
      ++noted;
    }
  }
  EXPECT_GT(noted, 290) << "nearly all of those with three digits are further than 1e-4 from a rotation";
}

TEST(PoseLayouts, MoreThanTheRoundingIsRefused) {
  RandomStream random(6);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d rotation = random.rotation();
    EXPECT_THAT(refusal(printed(1.003 * rotation, 3)), HasSubstr("not rigid"));
    EXPECT_THAT(refusal(printed(1.0003 * rotation, 4)), HasSubstr("not rigid"));
    EXPECT_THAT(refusal(printed(-rotation, 3)), AllOf(HasSubstr("not rigid"), HasSubstr(": it is mirrored")));
    const std::string coarse = refusal(printed(rotation, 2));
    if (!coarse.empty()) {
      EXPECT_THAT(coarse, EndsWith("it is printed with too few digits, expected at least 3 behind the point"));
    }
  }
  // Three significant digits: the small entry has more behind the point.
  EXPECT_THAT(read_text("0.783 -0.482 0.394 1\n0.549 0.833 -0.0715 2\n-0.293 0.272 0.916 3\n").notes,
              ElementsAre(HasSubstr("printed with 3 digits")));
}

TEST(PoseLayouts, AFileOfTheLiteralNameComesFirst) {
  const std::string pose = "1 0 0 1\n0 1 0 2\n0 0 1 3\n", log = "0 1 2\n" + pose + "0 0 0 1\n";
  put_text(folder() / "a.log", replaced(log, "1\n0 1 0 2", "9\n0 1 0 2"));
  put_text(folder() / "a.log:1,0", log);
  EXPECT_EQ(read_transform(folder() / "a.log:1,0").translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read_transform(folder() / "a.log").translation, Eigen::Vector3d(9, 2, 3));
  EXPECT_EQ(split_transform_name(folder() / "a.log:1,0").key, "");
  EXPECT_EQ(split_transform_name(folder() / "a.log:0,1").key, "0,1");
  EXPECT_EQ(split_transform_name(folder() / "none.log:0,1").file, folder() / "none.log:0,1");
  EXPECT_THAT(io_error_of([] { read_transform(folder() / "none.log:0,1"); }),
              HasSubstr("none.log:0,1: does not exist"));
}

}  // namespace
}  // namespace corral
