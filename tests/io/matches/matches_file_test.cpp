// SPDX-License-Identifier: MIT
#include "io/matches/matches_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/disk/file.h"
#include "kernel/synthetic.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::put_text;
using testing::replaced;
using testing::ScratchFolder;
using ::testing::StartsWith;

const std::string kSix = "source_x,source_y,source_z,target_x,target_y,target_z";
const std::string kPreamble = "# corral matches 1\n# resolution 0.5\n";
const std::string kSmallest = kPreamble + kSix + "\n1,2,3,4,5,6\n";

CorrespondenceSet read_text(const std::string& text) {
  const ScratchFolder folder;
  return read_matches(put_text(folder / "matches.csv", text));
}

/// What the reader says after the name of the file; empty if it accepts the text.
std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "matches.csv", text);
  return complaint(path, [&] { read_matches(path); });
}

CorrespondenceSet full_table(int rows) {
  SyntheticOptions options;
  options.matches = rows;
  CorrespondenceSet table = make_synthetic_problem(options).matches;
  table.source_keypoints.clear();
  table.target_keypoints.clear();
  for (int row = 0; row < rows; ++row) {
    table.source_keypoints.push_back(3 * row);
    table.target_keypoints.push_back(2147483647 - row);
  }
  table.source_centroid = Eigen::Vector3d(0.1, -2e-9, 3e12);
  return table;
}

void expect_same(const CorrespondenceSet& read, const CorrespondenceSet& written) {
  EXPECT_EQ(read.source_points, written.source_points);
  EXPECT_EQ(read.target_points, written.target_points);
  EXPECT_EQ(read.source_frames, written.source_frames);
  EXPECT_EQ(read.target_frames, written.target_frames);
  EXPECT_EQ(read.source_keypoints, written.source_keypoints);
  EXPECT_EQ(read.target_keypoints, written.target_keypoints);
  EXPECT_EQ(read.feature_distance, written.feature_distance);
  EXPECT_EQ(read.second_feature_distance, written.second_feature_distance);
  EXPECT_EQ(read.resolution, written.resolution);
  EXPECT_EQ(read.source_centroid, written.source_centroid);
  EXPECT_EQ(matches_text(read), matches_text(written)) << "the sign of a zero is kept";
}

TEST(MatchesFile, WritesTheFormatOfTheIssue) {
  const std::string text = matches_text(full_table(1));
  EXPECT_THAT(text, StartsWith("# corral matches 1\n# resolution 1\n# source_centroid 0.1 -2e-09 3e+12\n"
                               "source_keypoint,target_keypoint," +
                               kSix +
                               ",feature_distance,second_feature_distance,"
                               "source_frame_0,source_frame_1,source_frame_2,source_frame_3,source_frame_4,"
                               "source_frame_5,source_frame_6,source_frame_7,source_frame_8,target_frame_0,"));
  EXPECT_EQ(matches_text(read_text(kSmallest)), kSmallest);
}

TEST(MatchesFile, ReadsBackWhatItWrote) {
  const CorrespondenceSet full = full_table(40);
  expect_same(read_text(matches_text(full)), full);
  CorrespondenceSet points_only;
  points_only.source_points = full.source_points;
  points_only.target_points = full.target_points;
  points_only.resolution = 1.0 / 3;
  expect_same(read_text(matches_text(points_only)), points_only);
  CorrespondenceSet half = points_only;
  half.target_frames = full.target_frames;
  half.second_feature_distance = full.second_feature_distance;
  half.source_keypoints = full.source_keypoints;
  expect_same(read_text(matches_text(half)), half);
  expect_same(read_text(matches_text(CorrespondenceSet())), CorrespondenceSet());
}

TEST(MatchesFile, KeepsExtremeNumbers) {
  CorrespondenceSet table = full_table(2);
  table.source_points << 5e-324, -0.0, 1e300, -1.7976931348623157e308, 2.2250738585072014e-308, 0.1;
  table.feature_distance << 0, 1e-310;
  table.resolution = 5e-324;
  table.source_frames[0].setZero();
  expect_same(read_text(matches_text(table)), table);
}

TEST(MatchesFile, FramesAreRowMajorAxes) {
  std::string header = kSix, row = "0,0,0,0,0,0";
  for (int i = 0; i < 9; ++i) {
    header += ",source_frame_" + std::to_string(i);
    row += "," + std::to_string(i);
  }
  const CorrespondenceSet table = read_text(kPreamble + header + "\n" + row + "\n");
  ASSERT_EQ(table.source_frames.size(), 1U);
  EXPECT_EQ(table.source_frames[0].row(1), Eigen::RowVector3d(3, 4, 5));
  EXPECT_TRUE(table.target_frames.empty());
}

TEST(MatchesFile, AcceptsCrLfAnyOrderOfColumnsAndOtherColumns) {
  const CorrespondenceSet table = read_text(
      "# corral matches 1\r\n# made by hand\r\n# source_centroid 7 8 9\r\n# resolution 0.25\r\n"
      "target_z, target_y ,target_x,note,source_z,source_y,source_x\r\n6,5,4,any text,3,2,1\r\n\r\n");
  EXPECT_EQ(table.source_points, Eigen::RowVector3d(1, 2, 3));
  EXPECT_EQ(table.target_points, Eigen::RowVector3d(4, 5, 6));
  EXPECT_EQ(table.resolution, 0.25);
  EXPECT_EQ(table.source_centroid, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(table.feature_distance.size(), 0);
}

TEST(MatchesFile, NamesAWrongBeginning) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty, expected a table of matches"));
  EXPECT_THAT(refusal(kSix + "\n1,2,3,4,5,6\n"), HasSubstr("line 1: found 'source_x"));
  EXPECT_THAT(refusal("# corral matches 2\n# resolution 1\n" + kSix + "\n"),
              HasSubstr("line 1: found '# corral matches 2', expected '# corral matches 1'"));
  EXPECT_THAT(refusal("# corral matches 1\n"), HasSubstr("line 2: the file ends here, expected '# resolution R'"));
  EXPECT_THAT(refusal(kPreamble), HasSubstr("line 3: the file ends here, expected the header of the columns"));
}

TEST(MatchesFile, TheResolutionIsAPositiveLength) {
  for (const char* bad : {"0", "-0", "-1", "1e-400"})
    EXPECT_THAT(refusal(replaced(kSmallest, "n 0.5", "n " + std::string(bad))),
                AllOf(HasSubstr("line 2: the resolution is '" + std::string(bad)), HasSubstr("above zero")));
  for (const char* bad : {"nan", "inf", "-inf", "x", "1e999"})
    EXPECT_THAT(refusal(replaced(kSmallest, "n 0.5", "n " + std::string(bad))),
                AllOf(HasSubstr("line 2: found '" + std::string(bad)), HasSubstr("number")));
  EXPECT_THAT(refusal(replaced(kSmallest, " 0.5", "")),
              HasSubstr("line 2: found '# resolution', expected '# resolution R'"));
  EXPECT_THAT(refusal(replaced(kSmallest, " 0.5", " 0.5 mm")), HasSubstr("line 2: found '# resolution 0.5 mm'"));
  EXPECT_THAT(refusal(replaced(kSmallest, "# resolution 0.5\n", "")),
              HasSubstr("no '# resolution R' before the header"));
}

TEST(MatchesFile, TheCentroidIsThreeFiniteNumbers) {
  for (const char* bad : {"1 2", "1 2 3 4", "", "1 2 nan", "1 inf 3", "a b c"})
    EXPECT_THAT(refusal(replaced(kSmallest, "0.5\n", "0.5\n# source_centroid " + std::string(bad) + "\n")),
                HasSubstr("line 3: found"))
        << bad;
}

TEST(MatchesFile, NamesAMissingOrDoubledColumn) {
  for (const char* column : {"source_x", "source_y", "source_z", "target_x", "target_y", "target_z"})
    EXPECT_THAT(refusal(replaced(kSmallest, column, "other")),
                HasSubstr("line 3: no column '" + std::string(column) + "', expected one"));
  EXPECT_THAT(refusal(replaced(kSmallest, "target_z", "source_x")),
              HasSubstr("line 3: column 'source_x' occurs twice"));
  EXPECT_THAT(refusal(kPreamble + kSix + ",feature_distance,feature_distance\n"), HasSubstr("occurs twice"));
}

TEST(MatchesFile, FramesComeWhole) {
  std::string header = kSix;
  for (int i = 0; i < 8; ++i) header += ",target_frame_" + std::to_string(i);
  EXPECT_THAT(refusal(kPreamble + header + "\n"), HasSubstr("line 3: no column 'target_frame_8', expected one"));
}

TEST(MatchesFile, NamesTheLineOfARaggedRow) {
  EXPECT_THAT(refusal(kSmallest + "1,2,3,4,5\n"), HasSubstr("line 5: found 5 fields, expected 6"));
  EXPECT_THAT(refusal(kSmallest + "1,2,3,4,5,6,\n"), HasSubstr("line 5: found 7 fields, expected 6"));
  EXPECT_THAT(refusal(kSmallest + "1 2 3 4 5 6\n"), HasSubstr("line 5: found 1 fields, expected 6"));
}

TEST(MatchesFile, NamesTheLineOfWhatIsNoFiniteNumber) {
  for (const char* bad : {"", "nan", "inf", "-inf", "x", "1.2.3", "1e999", "0x1"})
    EXPECT_THAT(refusal(kSmallest + "1,2,3,4,5," + bad + "\n"),
                AllOf(HasSubstr("line 5: found '" + std::string(bad) + "'"), HasSubstr("number")));
  for (const char* column : {"feature_distance", "second_feature_distance"})
    EXPECT_THAT(refusal(kPreamble + kSix + "," + column + "\n1,2,3,4,5,6,nan\n"), HasSubstr("line 4: found 'nan'"));
}

TEST(MatchesFile, KeypointsAreVertexNumbers) {
  const std::string text = kPreamble + "source_keypoint," + kSix + "\n";
  EXPECT_THAT(read_text(text + "0,1,2,3,4,5,6\n").source_keypoints, ElementsAre(0));
  for (const char* bad : {"-1", "1.5", "", "2147483648", "99999999999999999999"})
    EXPECT_THAT(refusal(text + bad + ",1,2,3,4,5,6\n"), HasSubstr("line 4: a keypoint is '" + std::string(bad)));
}

// The format has no count of its rows: a cut at the end of a line leaves a shorter, valid table.
TEST(MatchesFile, TruncationAtEveryOtherByteIsAnError) {
  const std::string whole = matches_text(full_table(3));
  const std::size_t first_row = whole.find('\n', whole.find("source_x")) + 1;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const bool between_rows = length >= first_row && whole[length - 1] == '\n';
    EXPECT_EQ(refusal(whole.substr(0, length)).empty(), between_rows) << "cut at byte " << length;
  }
}

TEST(MatchesFile, TheSpaceBehindTheSharpMayBeMissing) {
  EXPECT_EQ(read_text(replaced(kSmallest, "# resolution 0.5", "#resolution 0.25")).resolution, 0.25);
}

TEST(MatchesFile, ThePreambleSaysEverythingOnce) {
  EXPECT_THAT(refusal(replaced(kSmallest, "# resolution 0.5\n", "# resolution 0.5\n# resolution 0.5\n")),
              HasSubstr("line 3: found '# resolution 0.5' a second time"));
  EXPECT_THAT(refusal(replaced(kSmallest, kSix, "# source_centroid 0 0 0\n# source_centroid 0 0 0\n" + kSix)),
              HasSubstr("line 4: found '# source_centroid 0 0 0' a second time"));
}

TEST(MatchesFile, AByteOrderMarkIsPassedOver) { EXPECT_EQ(read_text("\xEF\xBB\xBF" + kSmallest).size(), 1); }

}  // namespace
}  // namespace corral
