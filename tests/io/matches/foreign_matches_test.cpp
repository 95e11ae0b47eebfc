// SPDX-License-Identifier: MIT
#include "io/matches/foreign_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/matches/label_file.h"
#include "tests/io/array/npy_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace corral::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Three matches, as they are given in every layout.
Points sources() {
  Points points(4, 3);
  points << 1, 2, 3, 4, 5, 6, 7, 8, 9, -1, -2, -3;
  return points;
}
Points targets() { return sources().array() + 0.5; }

class ForeignMatchesTest : public ::testing::Test {
 protected:
  std::string put(const std::string& name, const std::string& text) {
    put_text(folder_ / name, text);
    return folder_ / name;
  }
  ForeignMatches read(const std::string& text, const std::string& name = "corr.txt") {
    return read_foreign_matches({put(name, text)});
  }
  template <class Call>
  std::string complaint(const Call& call) {
    try {
      call();
    } catch (const IoError& error) {
      return error.what();
    }
    return "nothing";
  }
  static void expect_whole(const ForeignMatches& found) {
    EXPECT_EQ(found.matches.source_points, sources());
    EXPECT_EQ(found.matches.target_points, targets());
    EXPECT_THAT(found.kept, ElementsAre(0, 1, 2, 3));
  }

  ScratchFolder folder_;
  const std::string rows_ = "1 2 3 1.5 2.5 3.5\n4 5 6 4.5 5.5 6.5\n7 8 9 7.5 8.5 9.5\n-1 -2 -3 -0.5 -1.5 -2.5\n";
};

TEST_F(ForeignMatchesTest, SixColumnsInAnySeparation) {
  expect_whole(read(rows_));
  for (const std::string separator : {",", ", ", ";", "\t"}) {
    std::string text = rows_;
    for (std::size_t at = 0; (at = text.find(' ', at)) != std::string::npos; at += separator.size())
      text.replace(at, 1, separator);
    expect_whole(read(text));
  }
  expect_whole(read("# a comment\nx1,y1,z1,x2,y2,z2\n" + [&] {
    std::string text = rows_;
    std::replace(text.begin(), text.end(), ' ', ',');
    return text;
  }()));
  const ForeignMatches open = read(rows_.substr(0, rows_.size() - 1));
  expect_whole(open);
  EXPECT_THAT(open.notes, ElementsAre(HasSubstr("lacks its end")));
}

TEST_F(ForeignMatchesTest, NamesSayWhichColumnsAreWhich) {
  const ForeignMatches found =
      read("label tgt_x tgt_y tgt_z src_x src_y src_z feature_distance\n1 4 5 6 1 2 3 0.25\n0 7 8 9 4 5 6 0.75\n");
  EXPECT_EQ(found.matches.source_points.row(1), Eigen::RowVector3d(4, 5, 6));
  EXPECT_EQ(found.matches.target_points.row(0), Eigen::RowVector3d(4, 5, 6));
  EXPECT_EQ(found.matches.feature_distance, Eigen::Vector2d(0.25, 0.75));
  EXPECT_THAT(found.labels, ElementsAre(true, false));
}

TEST_F(ForeignMatchesTest, ASeventhColumnOfZerosAndOnesIsLabels) {
  const ForeignMatches found = read("1 2 3 4 5 6 1\n4 5 6 7 8 9 0\n");
  EXPECT_THAT(found.labels, ElementsAre(true, false));
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("taken for labels")));
  const ForeignMatches other = read("1 2 3 4 5 6 0.5\n4 5 6 7 8 9 0\n");
  EXPECT_THAT(other.labels, IsEmpty());
  EXPECT_THAT(other.notes, ElementsAre("1 further column not read"));
}

TEST_F(ForeignMatchesTest, ColumnsInsteadOfRowsAreNoted) {
  const ForeignMatches found =
      read("1,4,7,-1\n2,5,8,-2\n3,6,9,-3\n1.5,4.5,7.5,-0.5\n2.5,5.5,8.5,-1.5\n3.5,6.5,9.5,-2.5\n");
  expect_whole(found);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("read as columns")));
}

TEST_F(ForeignMatchesTest, TwoFilesOfPoints) {
  const std::string by_rows = put("src.txt", "1 2 3\n4 5 6\n7 8 9\n-1 -2 -3\n");
  const std::string by_columns = put("dst.csv", "1.5,4.5,7.5,-0.5\n2.5,5.5,8.5,-1.5\n3.5,6.5,9.5,-2.5\n");
  expect_whole(read_foreign_matches({by_rows, by_columns}));
  const std::string shorter = put("less.txt", "1 2 3\n4 5 6\n");
  EXPECT_THAT(complaint([&] { read_foreign_matches({by_rows, shorter}); }), HasSubstr("one for each of the 4"));
  const std::string square = put("square.txt", "1 2 3\n4 5 6\n7 8 9\n");
  EXPECT_THAT(read_foreign_matches({square, square}).notes,
              ElementsAre(HasSubstr("read as rows"), HasSubstr("read as rows")));
}

TEST_F(ForeignMatchesTest, IndexPairsCountFromZeroUnlessTheyShowOtherwise) {
  const Points source = sources(), target = targets();
  const auto indexed = [&](const std::string& text, std::optional<int> first = {}) {
    return read_foreign_matches({put("corr.txt", text), "", &source, &target, first});
  };
  EXPECT_THAT(indexed("3 0\n1 2\n").matches.source_keypoints, ElementsAre(3, 1));
  EXPECT_EQ(indexed("3 0\n1 2\n").matches.target_points.row(1), target.row(2));
  const ForeignMatches one = indexed("4 1\n2 3\n");
  EXPECT_THAT(one.matches.source_keypoints, ElementsAre(3, 1));
  EXPECT_THAT(one.notes, ElementsAre(HasSubstr("count from 1")));
  EXPECT_THAT(indexed("3 1\n1 2\n", 1).matches.source_keypoints, ElementsAre(2, 0));
  EXPECT_EQ(indexed("3 0\n1 2\n0 0\n1 1\n2 2\n3 3\n").rows, 6);
  EXPECT_THAT(complaint([&] { indexed("3 0\n1 4\n"); }), HasSubstr("line 2: the index of a target point is 4"));
  EXPECT_THAT(complaint([&] { indexed("3 0\n-1 1\n"); }), HasSubstr("line 2: the index of a source point is -1"));
  EXPECT_THAT(complaint([&] { indexed("3 0\n0.5 1\n"); }), HasSubstr("six coordinates"));
  EXPECT_THAT(complaint([&] { read("3 0\n1 2\n"); }), HasSubstr("expected the clouds"));
}

TEST_F(ForeignMatchesTest, RowsWithANanAreLeftOutAndCounted) {
  const ForeignMatches found = read("1 2 3 4 5 6 1\nnan 5 6 7 8 9 1\n1 1 1 2 2 nan 0\n7 7 7 8 8 8 0\n");
  EXPECT_THAT(found.kept, ElementsAre(0, 3));
  EXPECT_EQ(found.matches.source_points.row(1), Eigen::RowVector3d(7, 7, 7));
  EXPECT_THAT(found.notes, ::testing::Contains("2 rows with a nan left out"));
  EXPECT_THAT(complaint([&] { read("1 2 3 4 5 6\n1 2 inf 4 5 6\n"); }), HasSubstr("line 2: a coordinate is infinite"));
  EXPECT_THAT(complaint([&] { read("nan 2 3 4 5 6\n"); }), HasSubstr("no row without a nan"));
}

TEST_F(ForeignMatchesTest, AnEmptyCellBelowNamesIsANan) {
  const std::string names = "x1,y1,z1,x2,y2,z2\n";
  const ForeignMatches found = read(names + "1,2,3,4,5,6\n1,,3,4,5,6\n1,2,3,4,5,\n7,8,9,1,2,3\n");
  EXPECT_THAT(found.kept, ElementsAre(0, 3));
  EXPECT_THAT(found.notes, ::testing::Contains("2 rows with a nan left out"));
  EXPECT_THAT(complaint([&] { read("1,2,3,4,5,6\n1,,3,4,5,6\n"); }), HasSubstr("line 2: found ''"));
}

TEST_F(ForeignMatchesTest, MalformedTextIsNamedByItsLine) {
  EXPECT_THAT(complaint([&] { read("1 2 3 4 5 6\n1 2 3 4 5\n"); }), HasSubstr("line 2: found 5 fields, expected 6"));
  EXPECT_THAT(complaint([&] { read("1 2 3 4 5 6\n1 2 x 4 5 6\n"); }), HasSubstr("line 2: found 'x'"));
  EXPECT_THAT(complaint([&] { read(""); }), HasSubstr("the file is empty"));
  EXPECT_THAT(complaint([&] { read("# nothing\n"); }), HasSubstr("expected rows of numbers"));
  EXPECT_THAT(complaint([&] { read("1.5 2 3\n4 5 6\n"); }), HasSubstr("two files of points"));
  EXPECT_THAT(complaint([&] { read("1 2 3\n4 5 6\n"); }), HasSubstr("the file of the target points"));
}

TEST_F(ForeignMatchesTest, ArraysOfNumpy) {
  std::vector<double> six, source, target;
  for (int row = 0; row < 4; ++row) {
    for (int axis = 0; axis < 3; ++axis) source.push_back(sources()(row, axis)), six.push_back(sources()(row, axis));
    for (int axis = 0; axis < 3; ++axis) target.push_back(targets()(row, axis)), six.push_back(targets()(row, axis));
  }
  expect_whole(read(npy("(4, 6)", six), "corr.npy"));
  expect_whole(read(npz({{"corr", npy("(4, 6)", six)}}), "a.npz"));
  const std::string pose = npy("(4, 4)", {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
  const ForeignMatches found = read(npz({{"src_corr_points", npy("(4, 3)", source)},
                                         {"ref_corr_points", npy("(1, 4, 3)", target)},
                                         {"transform", pose},
                                         {"corr_scores", npy("(4,)", {1, 2, 3, 4})},
                                         {"gt_labels", npy("(4,)", {1, 0, 0, 1})}}),
                                    "a.npz");
  expect_whole(found);
  EXPECT_EQ(found.target_from_source->translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(found.target_from_source->rotation(1, 0), 1);
  EXPECT_THAT(found.labels, ElementsAre(true, false, false, true));
  EXPECT_THAT(found.notes, ElementsAre("arrays that are not read: corr_scores"));
  const std::string other = put("b.npz", npz({{"mine", npy("(4, 3)", source)}, {"yours", npy("(4, 3)", target)}}));
  EXPECT_THAT(complaint([&] { read_foreign_matches({other}); }), HasSubstr("mine, yours"));
  expect_whole(read_foreign_matches({other + ":mine", other + ":yours"}));
}

TEST_F(ForeignMatchesTest, Labels) {
  const auto labels = [&](const std::string& text) { return read_labels(put("label.txt", text), 4); };
  EXPECT_THAT(labels("1\n0\n0\n1\n"), ElementsAre(true, false, false, true));
  EXPECT_THAT(labels("1,0,0,1\n"), ElementsAre(true, false, false, true));
  EXPECT_THAT(labels("0\n3\n"), ElementsAre(true, false, false, true));
  EXPECT_THAT(complaint([&] { labels("1\n0\n1\n"); }), HasSubstr("a label 0 or 1 for each of 4 matches"));
  EXPECT_THAT(complaint([&] { labels("1\n4\n"); }), HasSubstr("line 2"));
  EXPECT_THAT(complaint([&] { labels("0.5\n"); }), HasSubstr("found 1 numbers"));
  EXPECT_THAT(read_labels(put("mask.npy", npy_of(npy_header("|b1", "(4,)"), std::string("\1\0\0\1", 4))), 4),
              ElementsAre(true, false, false, true));
}

}  // namespace
}  // namespace corral
