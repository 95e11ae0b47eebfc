// SPDX-License-Identifier: MIT
// A study in shards: evaluate --shard, merge, plan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Shards : public ::testing::Test {
 protected:
  Shards() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
  }
  Outcome evaluate(const std::string& rest) const { return place_.corral("evaluate small.toml --data data " + rest); }
  Outcome shard(const std::string& shard, const std::string& run) const {
    return evaluate("-o " + run + " --shard " + shard);
  }
  Outcome merge(const std::string& rest) const { return place_.corral("merge " + rest); }
  std::map<std::string, std::string> whole() const {
    EXPECT_EQ(evaluate("-o whole").status, 0);
    return lasting_files(place_, "whole");
  }
  const Workplace place_;
};

TEST_F(Shards, AnyNumberInAnyOrderGivesTheSameStudy) {
  const auto expected = whole();
  for (const int count : {1, 2, 7, 50}) {
    const std::string run = "run" + std::to_string(count), of = "/" + std::to_string(count);
    for (int i = 0; i < count; ++i)  // 3 has no divisor in common with them
      ASSERT_EQ(shard(std::to_string(1 + (3 * i + 1) % count) + of, run).status, 0);
    for (int time = 1; time <= 2; ++time) {
      const Outcome outcome = merge(run);
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(outcome.err, "6 pairs, 0 failed; the study is in " + run + "\n");
      EXPECT_THAT(outcome.out, HasSubstr("precision"));
      EXPECT_EQ(lasting_files(place_, run), expected) << count << " shards, merged " << time << " times";
    }
  }
}

TEST_F(Shards, OnesInFoldersOfTheirOwnAreBroughtTogether) {
  const auto expected = whole();
  for (const char* i : {"1", "2", "3"}) ASSERT_EQ(shard(i + std::string("/3"), std::string("part") + i).status, 0);
  EXPECT_EQ(merge("part2 part3 part1").status, 0);
  EXPECT_EQ(lasting_files(place_, "part2"), expected);
  EXPECT_EQ(merge("part2 part3 part1").status, 0) << "again";
  EXPECT_EQ(lasting_files(place_, "part2"), expected);
  EXPECT_THAT(merge("part2 data").err, HasSubstr("data: has no journals"));
}

TEST_F(Shards, WhatIsMissingIsNamed) {
  ASSERT_EQ(shard("1/3", "run").status, 0);
  Outcome outcome = merge("run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.err,
            "corral: run: is not whole: missing 2/3, 3/3; repeat these shards, or 'corral evaluate' without --shard\n");
  ASSERT_EQ(shard("3/3", "run").status, 0);
  const std::string journal = "run/units/3-of-3.1.journal";
  const std::string text = place_.text(journal);
  place_.put(journal, text.substr(0, text.size() - 1));
  outcome = merge("run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("missing 2/3, unfinished 3/3 (1 of 2 pairs);"));
  EXPECT_FALSE(std::filesystem::exists(place_ / "run/summary.csv"));
  ASSERT_EQ(shard("3/3", "run").status, 0);
  EXPECT_EQ(lines_of(place_.text("run/units/3-of-3.2.journal")).size(), 2u) << "one pair was left";
  EXPECT_THAT(merge("run").err, HasSubstr("is not whole: missing 2/3;"));
  const auto expected = whole();
  EXPECT_EQ(evaluate("-o run").status, 0) << "without --shard the rest is done";
  EXPECT_EQ(lines_of(place_.text("run/units/1-of-1.1.journal")).size(), 1 + 2u);
  EXPECT_EQ(lasting_files(place_, "run"), expected);
}

TEST_F(Shards, WhatDoesNotBelongIsNamed) {
  EXPECT_EQ(merge("nowhere").status, 3);
  ASSERT_EQ(shard("1/2", "run").status, 0);
  ASSERT_EQ(shard("2/2", "run").status, 0);
  const auto put_line = [&](const std::string& name, std::size_t number, const std::string& line) {
    std::vector<std::string> lines = lines_of(place_.text(name));
    lines.at(number) = line;
    place_.put(name, joined(lines));
  };
  const std::string journal = "run/units/2-of-2.1.journal", before = place_.text(journal);
  put_line(journal, 1, "0123\n");
  EXPECT_THAT(merge("run").err, AllOf(HasSubstr("unfinished 2/2 (2 of 3 pairs)"), HasSubstr(journal + " line 2")));
  place_.put(journal, replaced(before, "corral journal 2", "corral journal 7"));
  EXPECT_THAT(merge("run").err, HasSubstr(journal + ", line 1: does not agree with its hash"));
  put_line(journal, 0, hashed(replaced(lines_of(before)[0].substr(33), "corral journal 2", "corral journal 7")));
  EXPECT_THAT(merge("run").err, HasSubstr("expected corral journal 2"));
  place_.put(journal, before);
  put_line(journal, 0, hashed(replaced(lines_of(before)[0].substr(33), "0.2.0", "0.0.9")));
  EXPECT_THAT(merge("run").err, HasSubstr("2-of-2.1.journal: was made by version 0.0.9 of the program, unlike "));
  place_.put(journal, before);
  EXPECT_EQ(merge("run").status, 0);
  ASSERT_EQ(evaluate("--set gc.tolerance_pr=2 --shard 1/3 -o other").status, 0);
  std::filesystem::copy(place_ / "other/units/1-of-3.1.journal", place_ / "run/units/1-of-3.1.journal");
  const Outcome outcome = merge("run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1-of-3.1.journal: was made from other experiments or settings, unlike "),
                                 HasSubstr("remove what does not belong")));
}

TEST_F(Shards, OverlappingOnesAgree) {
  const auto expected = whole();
  for (const char* each : {"1/2", "2/2", "1/3"}) ASSERT_EQ(shard(each, "run").status, 0);
  Outcome outcome = merge("run");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("note: shards 1/2 and 1/3 overlap: "));
  EXPECT_EQ(lasting_files(place_, "run"), expected);
  // Another result of the same pair is no study.
  std::vector<std::string> lines = lines_of(place_.text("run/units/1-of-3.1.journal"));
  lines[1] = hashed(replaced(lines[1].substr(33), "\"matches\":", "\"matches\":1"));
  place_.put("run/units/1-of-3.1.journal", joined(lines));
  outcome = merge("run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("1-of-3.1.journal: has another result of the pair "));
}

// Where a file is missing its size is unknown, and with it the split of the others: what is left is named all the same.
TEST_F(Shards, AFileThatWasMissingForOneOfThem) {
  const std::string mesh = place_.text("data/b3r/m1.ply");
  std::filesystem::remove(place_ / "data/b3r/m1.ply");
  EXPECT_EQ(shard("1/2", "run").status, 4);
  place_.put("data/b3r/m1.ply", mesh);
  ASSERT_EQ(shard("2/2", "run").status, 0);
  EXPECT_THAT(merge("run").err, AllOf(HasSubstr("1/2"), Not(HasSubstr("2/2"))));
  EXPECT_EQ(shard("1/2", "run").status, 0);
  EXPECT_EQ(merge("run").status, 0);
  EXPECT_EQ(lasting_files(place_, "run"), whole());
}

TEST_F(Shards, DataThatChangedInBetweenAreNamed) {
  ASSERT_EQ(shard("1/2", "run").status, 0);
  place_.put("data/b3r/m1.ply", place_.text("data/b3r/m1.ply") + " ");
  place_.put("data/b3r/m2.ply", place_.text("data/b3r/m2.ply") + " ");
  ASSERT_EQ(shard("2/2", "run").status, 0);
  EXPECT_THAT(merge("run").err, AllOf(HasSubstr("a different version of"), HasSubstr("data/b3r/m")));
}

TEST_F(Shards, NothingIsLostOrDoneTwiceWhenTheyAreKilled) {
  const std::string line = "cd '" + (place_ / "") +
                           "' && '" CORRAL_SOURCE_DIR "/tests/interruption' '" CORRAL_PROGRAM
                           "' data 30 small.toml >log 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << place_.text("log");
  EXPECT_THAT(place_.text("log"), HasSubstr("30 kills, "));
}

TEST_F(Shards, ThePlanIsTheSplit) {
  const auto plan = place_.corral("plan small.toml --data data --shards 4 --json").json();
  EXPECT_EQ(plan["pairs"], 6);
  ASSERT_EQ(plan["shards"].size(), 4u);
  for (const auto& part : plan["shards"]) {
    const Outcome outcome = shard(part["shard"], "run");
    EXPECT_THAT(outcome.err, HasSubstr("shard " + part["shard"].get<std::string>() + ": " +
                                       std::to_string(part["pairs"].get<int>()) +
                                       " pairs, 0 failed; when all shards "
                                       "are done: corral merge run"));
    EXPECT_GT(part["seconds"], 0);
    EXPECT_GT(part["peak_bytes"], 1e7);
  }
  EXPECT_THAT(place_.corral("plan small.toml --data data --shards 4").out, HasSubstr("4/4"));
  const auto like = place_.corral("plan small.toml --data data --like run --json").json();
  EXPECT_GT(like["seconds"], 0);
  EXPECT_NE(like["seconds"], plan["seconds"]);
}

TEST_F(Shards, SaysWhatIsWrongWithTheCall) {
  for (const char* wrong : {"0/2", "3/2", "1", "1/0", "a/b", "1/2/3", "-1/2", "1/1000001"}) {
    const Outcome outcome = shard(wrong, "run");
    EXPECT_EQ(outcome.status, 2) << wrong;
    EXPECT_THAT(outcome.err, HasSubstr("--shard")) << wrong;
  }
  EXPECT_EQ(place_.corral("plan small.toml --data data --shards 0").status, 2);
  EXPECT_FALSE(std::filesystem::exists(place_ / "run"));
}

}  // namespace
}  // namespace corral
