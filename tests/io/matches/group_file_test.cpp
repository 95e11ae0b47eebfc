// SPDX-License-Identifier: MIT
#include "io/matches/group_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/disk/file.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::AllOf;
using testing::complaint;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;
using testing::put_text;
using testing::replaced;
using testing::ScratchFolder;
using ::testing::StartsWith;

const std::string kHeader = "row,selected,score\n";

GroupTable read_text(const std::string& text) {
  const ScratchFolder folder;
  return read_group(put_text(folder / "group.csv", text));
}

std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "group.csv", text);
  return complaint(path, [&] { read_group(path); });
}

TEST(GroupFile, WritesTheFormatOfTheIssue) {
  EXPECT_EQ(group_text({3, {1}, {}}), kHeader + "0,0,\n1,1,\n2,0,\n");
  EXPECT_EQ(group_text({2, {0, 1}, {0.1, -0.0}}), kHeader + "0,1,0.1\n1,1,-0\n");
  EXPECT_EQ(group_text({0, {}, {}}), kHeader);
}

TEST(GroupFile, ReadsBackWhatItWrote) {
  for (const GroupTable& group : {GroupTable{5, {0, 2, 4}, {}}, GroupTable{3, {}, {5e-324, 1e300, -0.1}},
                                  GroupTable{2, {0, 1}, {1.0 / 3, -0.0}}, GroupTable{}}) {
    const GroupTable read = read_text(group_text(group));
    EXPECT_EQ(read.matches, group.matches);
    EXPECT_EQ(read.selected, group.selected);
    EXPECT_EQ(read.scores, group.scores);
    EXPECT_EQ(group_text(read), group_text(group)) << "the sign of a zero is kept";
  }
}

TEST(GroupFile, AcceptsCrLf) {
  const GroupTable read = read_text(replaced(kHeader + "0,0,1.5\n1,1,2\n", "\n", "\r\n"));
  EXPECT_THAT(read.selected, ElementsAre(1));
  EXPECT_THAT(read.scores, ElementsAre(1.5, 2));
}

TEST(GroupFile, NamesTheLineOfAMalformedRow) {
  EXPECT_THAT(refusal(kHeader + "0,0,\n1,1\n"), HasSubstr("line 3: found 2 fields, expected row,selected,score"));
  EXPECT_THAT(refusal(kHeader + "0,0,,\n"), HasSubstr("line 2: found 4 fields"));
  EXPECT_THAT(refusal(kHeader + "0,0,\n0,1,\n"), AllOf(HasSubstr("line 3"), HasSubstr("the row is '0'")));
  EXPECT_THAT(refusal(kHeader + "1,0,\n"), AllOf(HasSubstr("line 2"), HasSubstr("the row is '1'")));
  EXPECT_THAT(refusal(kHeader + "-1,0,\n"), HasSubstr("line 2"));
  for (const char* selected : {"2", "-1", "", "true", "0.5", "nan"})
    EXPECT_THAT(refusal(kHeader + "0," + selected + ",\n"), HasSubstr("line 2: selected is '" + std::string(selected)));
  for (const char* score : {"nan", "inf", "x", "1.2.3"})
    EXPECT_THAT(refusal(kHeader + "0,1," + score + "\n"), HasSubstr("line 2: found '" + std::string(score)));
}

TEST(GroupFile, ScoresStandOnAllRowsOrOnNone) {
  EXPECT_THAT(refusal(kHeader + "0,0,1\n1,0,\n"), HasSubstr("line 3: some rows have a score and some have none"));
  EXPECT_THAT(refusal(kHeader + "0,0,\n1,0,1\n"), HasSubstr("line 3: some rows have a score and some have none"));
}

TEST(GroupFile, NamesAWrongHeader) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("\n \n"), HasSubstr("expected the header row,selected,score"));
  EXPECT_THAT(refusal("row,score,selected\n"), HasSubstr("line 1: found 'row,score,selected'"));
  EXPECT_THAT(refusal("0,1,\n"), HasSubstr("line 1"));
}

TEST(GroupFile, MustHaveARowPerMatch) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "group.csv", group_text({3, {1}, {}}));
  EXPECT_THAT(read_group_of(path, 3).selected, ElementsAre(1));
  for (const int matches : {0, 2, 4})
    EXPECT_EQ(io_error_of([&] { read_group_of(path, matches); }),
              path + ": has 3 rows, expected " + std::to_string(matches) + ", one per match");
}

// Without a count in the file, a cut at the end of a line is detected only if the number of matches is known.
TEST(GroupFile, TruncationAtEveryByteIsAnError) {
  const ScratchFolder folder;
  const std::string whole = group_text({12, {1, 3, 10}, std::vector<double>(12, -1.25)});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string path = put_text(folder / "group.csv", whole.substr(0, length));
    EXPECT_THAT(io_error_of([&] { read_group_of(path, 12); }), StartsWith(path)) << "cut at byte " << length;
    const bool between_rows = length >= kHeader.size() && whole[length - 1] == '\n';
    EXPECT_EQ(io_error_of([&] { read_group(path); }).empty(), between_rows) << "cut at byte " << length;
  }
}

}  // namespace
}  // namespace corral
