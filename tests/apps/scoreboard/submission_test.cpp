// SPDX-License-Identifier: MIT
#include "apps/scoreboard/submission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/disk/file.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using testing::lines_in;
using ::testing::Not;
using testing::Workplace;

/// A data set of two tables with truths.
void put_set(const Workplace& place) {
  place.put_problem();
  make_folder(place / "set");
  place.put("set/dataset.toml", "name = \"two\"\n");
  place.put(
      "set/pairs.csv",
      "pair,source,target,truth,matches\none,,,../truth.txt,../matches.csv\nother,,,../truth.txt,../matches.csv\n");
}

/// Selects every row.
void put_program(const Workplace& place, const std::string& name) {
  place.put(name,
            "import sys\nrows = [line for line in open(sys.argv[1]) if not line.startswith('#')][1:]\n"
            "open(sys.argv[2], 'w').write('\\n'.join('1' for _ in rows) + '\\n')\n");
}

TEST(Scoreboard, FromAScriptToTheSite) {
  const Workplace place;
  put_set(place);
  put_program(place, "mine.py");
  auto packed = place.corral(
      "scoreboard pack --data set --external \"mine=python3 mine.py {matches} {group}\" --licence MIT --deterministic "
      "-o sent");
  ASSERT_EQ(packed.status, 0) << packed.err;
  EXPECT_THAT(place.text("sent/method.toml"), HasSubstr("deterministic = true"));
  EXPECT_EQ(lines_in(place.text("sent/tables.csv")), 3U);
  ASSERT_EQ(place.corral("scoreboard check sent --data set").status, 0);
  auto added = place.corral("scoreboard add sent --data set -o theirs");
  ASSERT_EQ(added.status, 0) << added.err;
  EXPECT_THAT(place.text("theirs/records.csv"), Not(HasSubstr(",gc,"))) << "ours are not run again";
  ASSERT_EQ(place.corral("evaluate scoreboard --data set -o ours").status, 0);
  auto written = place.corral("scoreboard write ours theirs -o site --no-checks");
  ASSERT_EQ(written.status, 0) << written.err;
  const std::string board = place.text("site/scoreboard-two.html");
  EXPECT_THAT(board, HasSubstr("<a href=\"method-mine.html\" title=\""));
  EXPECT_THAT(board, HasSubstr("submitted, time as stated"));
  EXPECT_THAT(board, HasSubstr("all correct matches"));
  EXPECT_THAT(place.text("site/method-mine.html"), HasSubstr("deterministic, as its authors say"));
  EXPECT_THAT(place.text("site/method-hough.html"), HasSubstr("local frames"));
  const auto scores = nlohmann::json::parse(place.text("site/scores.json"));
  EXPECT_EQ(scores["boards"][0]["methods"].size(), 19U) << "17 of ours, mine and the oracle";
}

TEST(Scoreboard, WhatIsWrongWithASubmissionIsSaid) {
  const Workplace place;
  put_set(place);
  ASSERT_EQ(place.corral("scoreboard pack --data set --method gc -o sent").status, 0);
  const auto wrong = [&] {
    const auto outcome = place.corral("scoreboard check sent --data set");
    EXPECT_EQ(outcome.status, 3);
    return outcome.err;
  };
  const std::string tables = place.text("sent/tables.csv");
  place.put("sent/tables.csv", tables.substr(0, tables.rfind("other")));
  EXPECT_THAT(wrong(), HasSubstr("it does not know the table other"));
  place.put("sent/tables.csv", tables + "more,0,1\n");
  EXPECT_THAT(wrong(), HasSubstr("it has the table more, which the data set lacks"));
  place.put("sent/tables.csv", tables);
  place.put("sent/labels/one.csv", "row,selected,score\n0,1,\n");
  EXPECT_THAT(wrong(), HasSubstr("labels/one.csv"));
  EXPECT_EQ(place.corral("scoreboard add sent --data set -o theirs").status, 3);
  ASSERT_EQ(place.corral("scoreboard pack --data set --method gc -o sent").status, 0);
  place.put("matches.csv", place.text("matches.csv") + "\n");
  EXPECT_THAT(wrong(), HasSubstr("its table one is not that of the data set"));
}

TEST(Scoreboard, OneMethodIsPacked) {
  const Workplace place;
  put_set(place);
  EXPECT_EQ(place.corral("scoreboard pack --data set -o sent").status, 2);
  EXPECT_EQ(place.corral("scoreboard pack --data set --method gc --external \"x=y {matches} {group}\" -o sent").status,
            2);
  place.put("set/pairs.csv", "pair,source,target,truth\none,a.ply,b.ply,\n");
  EXPECT_EQ(place.corral("scoreboard pack --data set --method gc -o sent").status, 3);
}

}  // namespace
}  // namespace corral
