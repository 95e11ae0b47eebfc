// SPDX-License-Identifier: MIT
// Selections and poses of other programs: evaluate --methods, merge, compare, report, score.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const char* const kExperiment = R"toml(
name = "tables"
dataset = "tables"
attribute = "level"
levels = [1]
groupers = ["gc", "ransac"]
)toml";

/// Five tables in two scenes; beside them "copy", which has the selections of GC, and "pose", which has the true poses.
class ForeignMethods : public ::testing::Test {
 protected:
  ForeignMethods() {
    for (const char* folder : {"data/tables", "copy", "pose"}) std::filesystem::create_directories(place_ / folder);
    place_.put("tables.toml", kExperiment);
    place_.put("data/tables/dataset.toml", "name = \"tables\"\nunits = \"m\"\n");
    std::string pairs = "pair,source,target,truth,matches,level,scene\n";
    for (int number = 1; number <= 5; ++number) {
      SyntheticOptions options;
      options.matches = 120, options.inlier_ratio = 0.4, options.noise_pr = 0.5, options.resolution = 0.125;
      options.seed = static_cast<std::uint64_t>(number);
      const SyntheticProblem made = make_synthetic_problem(options);
      const std::string name = "p" + std::to_string(number);
      place_.put("data/tables/" + name + ".csv", matches_text(made.matches));
      place_.put("data/tables/" + name + ".txt", transform_text(made.truth));
      place_.put("pose/" + name + ".txt", transform_text(made.truth));
      pairs += name + ",,," + name + ".txt," + name + ".csv,1," + (number < 4 ? "kitchen" : "lounge") + "\n";
    }
    place_.put("data/tables/pairs.csv", pairs);
    EXPECT_EQ(place_.corral("evaluate tables.toml --data data -o alone").status, 0);
    for (const StudyRecord& record : read_study(place_ / "alone").records)
      if (record.method == "gc") put_copy(record.pair, selected(record, "alone"));
    place_.put("methods.toml",
               "[[method]]\nname = \"copy\"\ntitle = \"GC, from files\"\nlabels = \"copy/{pair}.txt\"\n"
               "time_ms = 1234.5\n[[method]]\nname = \"pose\"\nposes = \"pose/{pair}.txt\"\n");
  }

  Indices selected(const StudyRecord& record, const std::string& run) const {
    return read_selections(place_ / (run + "/" + record.selection)).selected.at(record.method);
  }
  void put_copy(const std::string& pair, const Indices& rows) const {
    std::vector<int> labels(120);
    for (const int row : rows) labels[static_cast<std::size_t>(row)] = 1;
    std::string text;
    for (const int label : labels) text += std::to_string(label) + "\n";
    place_.put("copy/" + pair + ".txt", text);
  }
  Outcome evaluate(const std::string& rest) const {
    return place_.corral("evaluate tables.toml --data data --methods methods.toml " + rest);
  }
  StudyRecord record(const std::string& run, const std::string& pair, const std::string& method) const {
    for (const StudyRecord& each : read_study(place_ / run).records)
      if (each.pair == pair && each.method == method) return each;
    ADD_FAILURE() << pair << " " << method;
    return {};
  }
  std::size_t lines(const std::string& file) const { return lines_of(place_.text(file)).size(); }
  const Workplace place_;
};

TEST_F(ForeignMethods, AreScoredAsGroupersAndStandInEverything) {
  const Outcome outcome = evaluate("-o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("copy"), HasSubstr("pose")));
  for (const char* pair : {"p1", "p2", "p3", "p4", "p5"}) {
    const StudyRecord own = record("run", pair, "gc"), copy = record("run", pair, "copy");
    EXPECT_EQ(copy.selected, own.selected);
    EXPECT_EQ(copy.f1, own.f1);
    EXPECT_EQ(copy.initial.mean_error_pr, own.initial.mean_error_pr);
    EXPECT_EQ(copy.refined.mean_error_pr, own.refined.mean_error_pr);
    EXPECT_EQ(selected(copy, "run"), selected(own, "run"));
    EXPECT_EQ(copy.stated_time_ms, 1234.5);
    EXPECT_FALSE(copy.time_ms) << "a stated time is no measured one";
    EXPECT_TRUE(own.time_ms && !own.stated_time_ms);
    EXPECT_LT(*record("run", pair, "pose").initial.mean_error_pr, 1e-9);
    EXPECT_GT(*record("run", pair, "pose").recall, 0.9);
    EXPECT_EQ(own.scene, pair[1] < '4' ? "kitchen" : "lounge");
  }
  const CsvTable summary = read_csv(place_ / "run/summary.csv");
  const auto cell = [&](std::size_t row, const char* column) {
    return summary.rows[row][static_cast<std::size_t>(summary.column(column))];
  };
  ASSERT_EQ(cell(2, "method"), "copy");
  EXPECT_EQ(cell(2, "stated_time_ms"), "1234.5");
  EXPECT_EQ(cell(0, "stated_time_ms"), "");
  EXPECT_THAT(place_.corral("compare run").out, AllOf(HasSubstr("gc - copy"), HasSubstr("copy - pose")));
  ASSERT_EQ(place_.corral("report run -o report").status, 0);
  EXPECT_THAT(place_.text("report/index.html"), AllOf(HasSubstr("GC, from files"), HasSubstr("time, as stated")));
  EXPECT_THAT(place_.text("report/tables/tables-tables-f1.tex"), HasSubstr("GC, from files"));
  EXPECT_THAT(place_.text("report/data/tables-tables-success-in-time.csv"), Not(HasSubstr("copy")));
}

TEST_F(ForeignMethods, NoAnswerIsAFailureOfThatMethodOnThatPair) {
  std::filesystem::remove(place_ / "copy/p2.txt");
  place_.put("copy/p3.txt", "0\n1\n1\n");
  place_.put("pose/p4.txt", "1 0 0 inf\n0 1 0 0\n0 0 1 0\n");
  const Outcome outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err, HasSubstr("5 pairs, 3 failed"));
  EXPECT_EQ(to_text(record("run", "p2", "copy").status), "failed: copy/p2.txt: does not exist: no answer to this pair");
  EXPECT_THAT(to_text(record("run", "p3", "copy").status),
              HasSubstr("copy/p3.txt, line 3: expected a label 0 or 1 for each of 120 matches"));
  EXPECT_THAT(to_text(record("run", "p4", "pose").status), HasSubstr("failed: pose/p4.txt"));
  for (const char* pair : {"p1", "p4", "p5"}) EXPECT_EQ(record("run", pair, "copy").status.state, MethodState::Refined);
  for (const char* pair : {"p2", "p3"}) EXPECT_EQ(record("run", pair, "gc").status.state, MethodState::Refined);
}

TEST_F(ForeignMethods, AnswersThatHaveChangedAreScoredAgain) {
  std::filesystem::remove(place_ / "copy/p2.txt");
  ASSERT_EQ(evaluate("-o run").status, 4);
  EXPECT_EQ(evaluate("-o run").status, 4);
  EXPECT_FALSE(std::filesystem::exists(place_ / "run/units/1-of-1.2.journal")) << "nothing was left to do";
  put_copy("p2", {0, 1, 2});
  put_copy("p5", {});
  ASSERT_EQ(evaluate("-o run").status, 0);
  EXPECT_EQ(lines("run/units/1-of-1.2.journal"), 3u) << "two pairs and the header";
  EXPECT_EQ(record("run", "p2", "copy").selected, 3);
  EXPECT_EQ(record("run", "p5", "copy").selected, 0);
  ASSERT_EQ(evaluate("-o fresh").status, 0);
  EXPECT_EQ(place_.text("run/summary.csv"), place_.text("fresh/summary.csv"));
  std::filesystem::remove(place_ / "copy/p1.txt");
  EXPECT_EQ(evaluate("-o run").status, 4) << "and taken back";
}

TEST_F(ForeignMethods, ShardsGiveTheSameStudyWithoutTheAnswersAtTheirMerge) {
  ASSERT_EQ(evaluate("-o whole").status, 0);
  for (const char* shard : {"2/3", "1/3", "3/3"}) ASSERT_EQ(evaluate("-o run --shard " + std::string(shard)).status, 0);
  std::filesystem::rename(place_ / "methods.toml", place_ / "away.toml");
  std::filesystem::rename(place_ / "copy", place_ / "away");
  const Outcome outcome = place_.corral("merge run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* file : {"summary.csv", "records.csv"}) {
    const auto text = [&](const std::string& run) {
      return std::string(file) == "records.csv" ? without_times(place_ / (run + "/records.csv"))
                                                : place_.text(run + "/" + file);
    };
    EXPECT_EQ(text("run"), text("whole")) << file;
  }
}

TEST_F(ForeignMethods, AnAnswerThatComesBackIsTheLatest) {
  const std::string before = place_.text("copy/p2.txt");
  for (const std::string& text : {before, std::string("0\n"), before}) {
    place_.put("copy/p2.txt", text);
    for (const char* shard : {"1/2", "2/2"}) evaluate("-o run --shard " + std::string(shard));
  }
  const Outcome outcome = place_.corral("merge run");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  ASSERT_EQ(evaluate("-o whole").status, 0);
  EXPECT_EQ(place_.text("run/summary.csv"), place_.text("whole/summary.csv"));
}

TEST_F(ForeignMethods, AMergeTakesTheLatestAnswersAndNamesShardsOfOthers) {
  place_.put("methods.toml", "[[method]]\nname = \"pose\"\nposes = \"all.json:{pair}\"\n");
  const auto put_poses = [&](double shift) {
    std::string text;
    for (int number = 1; number <= 5; ++number)
      text += (text.empty() ? "{" : ", ") + ("\"p" + std::to_string(number)) + "\": [[1,0,0," + std::to_string(shift) +
              "],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
    place_.put("all.json", text + "}");
  };
  put_poses(1);
  for (const char* shard : {"1/2", "2/2"}) ASSERT_EQ(evaluate("-o run --shard " + std::string(shard)).status, 0);
  put_poses(2);
  ASSERT_EQ(evaluate("-o run --shard 1/2").status, 0);
  const Outcome outcome = place_.corral("merge run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("missing 2/2"), HasSubstr("answers of other programs that have changed")));
  ASSERT_EQ(evaluate("-o run --shard 2/2").status, 0);
  ASSERT_EQ(place_.corral("merge run").status, 0);
  ASSERT_EQ(evaluate("-o whole").status, 0);
  EXPECT_EQ(place_.text("run/summary.csv"), place_.text("whole/summary.csv"));
}

// A program that selects what GC does, by calling this one.
const char* const kGcAgain = "#!/bin/sh\n'" CORRAL_PROGRAM "' group \"$1\" -m gc -o \"$2\"\n";

TEST_F(ForeignMethods, AProgramThatIsCalledStandsBesideTheGroupers) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "this program calls itself, and the limit on its memory leaves AddressSanitizer no room for its shadow";
#endif
  place_.put("again.sh", kGcAgain);
  const std::string call =
      "evaluate tables.toml --data data --external 'again=sh again.sh {matches} {group}' "
      "--external 'bad=sh -c \"exit 139\" {matches} {group}' --external-timeout 50 ";
  const Outcome outcome = place_.corral(call + "-o run");
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  for (const char* pair : {"p1", "p2", "p3", "p4", "p5"}) {
    const StudyRecord own = record("run", pair, "gc"), again = record("run", pair, "again");
    EXPECT_EQ(selected(again, "run"), selected(own, "run"));
    EXPECT_EQ(again.refined.mean_error_pr, own.refined.mean_error_pr);
    EXPECT_TRUE(again.time_ms && !again.stated_time_ms);
    EXPECT_EQ(to_text(record("run", pair, "bad").status), "failed: bad: ended by signal 11 (status 139)");
    EXPECT_EQ(own.status.state, MethodState::Refined) << "one record each, and nothing else";
  }
  EXPECT_THAT(place_.text("run/manifest.json"), HasSubstr("sh again.sh {matches} {group}"));
  for (const char* shard : {"2/2", "1/2"}) place_.corral(call + "-o shards --shard " + shard);
  ASSERT_EQ(place_.corral("merge shards").status, 4);
  EXPECT_EQ(place_.text("shards/summary.csv"), place_.text("run/summary.csv"));
  EXPECT_EQ(place_.corral(call + "-o run").status, 4);
  EXPECT_FALSE(std::filesystem::exists(place_ / "run/units/1-of-1.2.journal")) << "nothing was left to do";
  place_.put("again.sh", "echo 3 > \"$2\"\n");
  place_.corral(call + "-o run");
  EXPECT_EQ(record("run", "p2", "again").selected, 1) << "another program, another result";
  EXPECT_EQ(place_.corral("evaluate tables.toml --data data --external gc=x -o other").status, 2);
}

TEST_F(ForeignMethods, WhatIsWrongInTheFileIsSaidBeforeAnythingRuns) {
  EXPECT_THAT(place_.corral("evaluate tables.toml --data data --methods none.toml -o run").err, HasSubstr("none.toml"));
  place_.put("methods.toml", "[[method]]\nname = \"gc\"\nlabels = \"a\"\n");
  Outcome outcome = evaluate("-o run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("methods.toml, line 2"));
  place_.put("methods.toml", "[[method]]\nname = \"other\"\nlabels = \"{fragment}.txt\"\n");
  EXPECT_THAT(evaluate("-o run").err, AllOf(HasSubstr("{fragment}"), HasSubstr("pairs.csv")));
  place_.put("times.toml", "name = \"times\"\ndataset = \"tables\"\nattribute = \"table_size\"\nlevels = [50]\n");
  place_.put("methods.toml", "[[method]]\nname = \"other\"\nlabels = \"a.txt\"\n");
  outcome = place_.corral("evaluate times.toml --data data --methods methods.toml -o run");
  EXPECT_THAT(outcome.err, HasSubstr("expected no methods of other programs"));
  EXPECT_FALSE(std::filesystem::exists(place_ / "run"));
}

TEST_F(ForeignMethods, OnePairIsScoredAlone) {
  const std::string files = "score data/tables/p1.csv ", truth = " --truth data/tables/p1.txt";
  const Outcome fit = place_.corral(files + "copy/p1.txt" + truth + " --json");
  ASSERT_EQ(fit.status, 0) << fit.err;
  ASSERT_EQ(evaluate("-o run").status, 0);
  EXPECT_EQ(fit.json()["selected"], *record("run", "p1", "copy").selected);
  EXPECT_EQ(fit.json()["f1"], *record("run", "p1", "copy").f1);
  EXPECT_EQ(fit.json()["initial_rotation_error_deg"], *record("run", "p1", "copy").initial.rotation_error_deg);
  const Outcome pose = place_.corral(files + "--pose pose/p1.txt" + truth + " --json");
  ASSERT_EQ(pose.status, 0) << pose.err;
  EXPECT_THAT(pose.err, HasSubstr("the matches within 5 pr"));
  EXPECT_EQ(pose.json()["selected"], *record("run", "p1", "pose").selected);
  EXPECT_LT(pose.json()["initial_translation_error_pr"], 1e-9);
  const Outcome both = place_.corral(files + "copy/p1.txt --pose pose/p1.txt" + truth);
  EXPECT_THAT(both.out, HasSubstr("pose: rot err deg"));
  EXPECT_EQ(place_.corral(files + truth).status, 2);
  EXPECT_THAT(place_.corral(files + "copy/none.txt" + truth).err, HasSubstr("no answer to this pair"));
}

}  // namespace
}  // namespace corral
