// SPDX-License-Identifier: MIT
#include "io/pose/transform_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "kernel/random.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::put_text;
using testing::replaced;
using testing::ScratchFolder;

const std::string kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

StoredTransform read_text(const std::string& text) {
  const ScratchFolder folder;
  return read_transform(put_text(folder / "pose.txt", text));
}

/// What the reader says after the name of the file; empty if it accepts the text.
std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "pose.xf", text);
  return complaint(path, [&] { read_transform(path); });
}

std::string text_of_rotation(const Eigen::Matrix3d& rotation) {
  return transform_text({rotation, Eigen::Vector3d(1, 2, 3)});
}

void expect_same(const RigidTransform& read, const RigidTransform& written) {
  EXPECT_EQ(read.rotation, written.rotation);
  EXPECT_EQ(read.translation, written.translation);
  EXPECT_EQ(transform_text(read), transform_text(written)) << "the sign of a zero is kept";
}

TEST(TransformFile, IsRowMajorTargetFromSource) {
  RigidTransform quarter_turn;
  quarter_turn.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  quarter_turn.translation << 7, 8.5, -9;
  EXPECT_EQ(transform_text(quarter_turn), "0 -1 0 7\n1 0 0 8.5\n0 0 1 -9\n0 0 0 1\n");
  const RigidTransform read = read_text("0 -1 0 7  1 0 0 8.5  0 0 1 -9  0 0 0 1");
  EXPECT_EQ(read * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(7, 9.5, -9));
}

TEST(TransformFile, ReadsBackWhatItWrote) {
  RandomStream random(5);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform motion{random.rotation(), 1e5 * random.direction()};
    expect_same(read_text(transform_text(motion)), motion);
  }
  RigidTransform extreme;
  extreme.translation << 5e-324, 1e300, -0.0;
  expect_same(read_text(transform_text(extreme)), extreme);
}

TEST(TransformFile, AcceptsCrLfTabsCommentsAndAMissingLastNewline) {
  EXPECT_EQ(read_text(replaced(kIdentity, "\n", "\r\n")).rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(read_text("# from rs1\n\n" + replaced(kIdentity, " ", "\t")).translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(read_text(kIdentity.substr(0, kIdentity.size() - 1)).rotation, Eigen::Matrix3d::Identity());
}

TEST(TransformFile, RefusesAnyOtherNumberOfNumbers) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("\n"), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("found 0 numbers in 0 rows, expected the 16 of a 4x4 matrix"));
  EXPECT_THAT(refusal("1 0 0 0\n0 1 0 0\n0 0 1\n"), HasSubstr("found 11 numbers in 3 rows"));
  EXPECT_THAT(refusal(kIdentity + "0\n"), HasSubstr("found 17 numbers"));
  EXPECT_THAT(refusal(kIdentity + kIdentity), HasSubstr("found 32 numbers"));
}

TEST(TransformFile, NamesTheLineOfWhatIsNoFiniteNumber) {
  for (const char* bad : {"nan", "inf", "-inf", "x", "1e999", "1:"})
    EXPECT_THAT(refusal(replaced(kIdentity, "0 1 0 0", "0 1 0 " + std::string(bad))),
                AllOf(HasSubstr("line 2: found '" + std::string(bad)), HasSubstr("number")));
}

TEST(TransformFile, RefusesWhatIsNotRigidWithTheNumbers) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal(),
                        stretch = Eigen::Vector3d(1, 1.5, 1).asDiagonal();
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.5;
  EXPECT_EQ(
      refusal(text_of_rotation(2 * Eigen::Matrix3d::Identity())),
      ", rotation: not rigid: R R^T differs from the identity by 3 and det R is 8, expected at most 0.0001 and +1: "
      "it is scaled by 2");
  EXPECT_THAT(refusal(text_of_rotation(mirror)),
              AllOf(HasSubstr("by 0 and det R is -1"), EndsWith(": it is mirrored")));
  EXPECT_THAT(refusal(text_of_rotation(0.001 * mirror * rotation)), EndsWith(": it is mirrored and scaled by 0.001"));
  EXPECT_THAT(refusal(text_of_rotation(stretch)), HasSubstr("by 1.25 and det R is 1.5"));
  EXPECT_THAT(refusal(text_of_rotation(shear)), HasSubstr("by 0.5 and det R is 1"));
  EXPECT_THAT(refusal(text_of_rotation(Eigen::Matrix3d::Zero())), HasSubstr("by 1 and det R is 0"));
  EXPECT_THAT(refusal(text_of_rotation(1.001 * rotation)), AllOf(HasSubstr("not rigid"), EndsWith("scaled by 1.001")));
  EXPECT_THAT(refusal(text_of_rotation(1e200 * rotation)), HasSubstr("not rigid"));
}

// Published poses have six digits: within 1e-4 a matrix is taken as it stands.
TEST(TransformFile, AcceptsRoundedRotations) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d rounded = (rotation.array() * 1e5).round().matrix() / 1e5;
  EXPECT_EQ(read_text(text_of_rotation(rounded)).rotation, rounded);
  EXPECT_NEAR((rounded * rounded.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-4);
}

TEST(TransformFile, TheLastRowIsExact) {
  EXPECT_EQ(refusal("1 0 0 2\n0 1 0 0\n0 0 1 0\n0 0 0.5 1\n"), ", row 4: is 0 0 0.5 1, expected 0 0 0 1");
  EXPECT_THAT(refusal("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n"), HasSubstr("row 4: is 0 0 0 2, expected 0 0 0 1"));
  EXPECT_THAT(
      refusal("1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n"),
      EndsWith(
          "row 4: is 1 2 3 1, expected 0 0 0 1: the matrix is transposed, its translation stands in the last row"));
  EXPECT_THAT(refusal("1 0 0\n0 1 0\n0 0 1\n1 2 3\n"), HasSubstr("4 rows of 3 numbers, expected 3 rows of 4"));
}

// The last row says nothing, so a cut in it loses nothing; one in the last number of the row before it is told.
TEST(TransformFile, TruncationAtEveryByteIsAnErrorOrToldOrLosesNothing) {
  RandomStream random(6);
  const RigidTransform motion{random.rotation(), random.direction()};
  const std::string whole = transform_text(motion);
  const std::size_t third = whole.size() - std::string("\n0 0 0 1\n").size();
  int told = 0;
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    const std::string cut = whole.substr(0, length);
    if (!refusal(cut).empty()) continue;
    if (length == third + 1) {
      expect_same(read_text(cut), motion);
      continue;
    }
    ++told;
    EXPECT_LE(length, third) << "cut at byte " << length;
    EXPECT_THAT(read_text(cut).notes, ElementsAre(HasSubstr("its last number is wrong"))) << "cut at byte " << length;
  }
  EXPECT_GT(told, 5);
  expect_same(read_text(whole.substr(0, whole.size() - 1)), motion);
  EXPECT_THAT(read_text(whole.substr(0, whole.size() - 1)).notes, IsEmpty());
}

}  // namespace
}  // namespace corral
