// SPDX-License-Identifier: MIT
#include "apps/results/level_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "apps/results/summary.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "tests/io/scratch.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;

StudyRecord record_of(const std::string& pair, const std::string& method, int true_matches, int selected, int correct) {
  StudyRecord record;
  record.experiment = "noise";
  record.level = "0.1";
  record.pair = pair;
  record.method = method;
  record.matches = 100;
  record.true_matches = true_matches;
  record.selected = selected;
  record.correct = correct;
  if (selected > 0) record.precision = correct / static_cast<double>(selected);
  if (true_matches > 0) {
    record.recall = correct / static_cast<double>(true_matches);
    record.f1 = 2.0 * correct / (selected + true_matches);
  }
  return record;
}

StudyFolder run_of(const std::vector<StudyRecord>& records) {
  StudyFolder run;
  run.experiments.push_back({"noise", "", "", "b3r", "noise_pr", "", {testing::step(0.1)}, {"gc"}, {}, 4, 1});
  run.records = records;
  return run;
}

TEST(LevelTable, AveragesAsTheDefinitionsSay) {
  StudyRecord aligned = record_of("a", "gc", 20, 10, 8);
  aligned.refined.mean_error_pr = 5.0;
  StudyRecord missed = record_of("b", "gc", 40, 40, 10);
  missed.refined.mean_error_pr = 5.1;
  const StudyRecord empty = record_of("c", "gc", 10, 0, 0);    // precision 0, and counted
  const StudyRecord excluded = record_of("d", "gc", 0, 5, 0);  // no right match: for no method
  StudyRecord failed;                                          // could not be matched
  failed.experiment = "noise";
  failed.level = "0.1";
  failed.pair = "e";
  failed.method = "gc";
  failed.status = {MethodState::Failed, "no keypoints"};
  const LevelTable level = experiment_tables(run_of({aligned, missed, empty, excluded, failed})).at(0).levels.at(0);
  const MethodColumns& columns = level.methods.at("gc");
  EXPECT_THAT(level.pairs, ElementsAre("a", "b", "c", "d", "e"));
  EXPECT_EQ(level.count(PairRole::Judged), 3);
  EXPECT_EQ(level.count(PairRole::Excluded), 1);
  EXPECT_EQ(level.count(PairRole::Failed), 1);
  EXPECT_EQ(columns.empty, 1);
  EXPECT_DOUBLE_EQ(mean_of(columns.numbers.at("precision")), (0.8 + 0.25 + 0) / 3);
  EXPECT_DOUBLE_EQ(mean_of(columns.numbers.at("precision_nonempty")), (0.8 + 0.25) / 2);
  EXPECT_DOUBLE_EQ(mean_of(columns.numbers.at("recall")), (0.4 + 0.25 + 0) / 3);
  EXPECT_DOUBLE_EQ(mean_of(columns.numbers.at("f1")), (16 / 30.0 + 0.25 + 0) / 3);  // of each pair, then the mean
  EXPECT_DOUBLE_EQ(mean_of(columns.numbers.at("success_5pr")), 1 / 3.0);
  EXPECT_DOUBLE_EQ(mean_of(level.of_pairs.at("inlier_ratio")), (0.2 + 0.4 + 0.1 + 0) / 4);
}

TEST(LevelTable, ExcludesPairsWithTooFewTrueMatches) {
  StudyFolder run = run_of({record_of("a", "gc", 2, 2, 1), record_of("b", "gc", 3, 2, 2)});
  run.experiments[0].least_true_matches = 3;
  const LevelTable level = experiment_tables(run).at(0).levels.at(0);
  EXPECT_EQ(level.count(PairRole::Excluded), 1);
  EXPECT_THAT(level.methods.at("gc").numbers.at("precision"), ElementsAre(IsNan(), 1.0));
}

TEST(LevelTable, AveragesRepeatsBeforePairs) {
  StudyRecord first = record_of("a", "ransac", 10, 10, 10), second = record_of("a", "ransac", 10, 0, 0);
  second.repeat = 1;
  first.time_ms = 1;
  second.time_ms = 3;
  const LevelTable level =
      experiment_tables(run_of({first, second, record_of("b", "ransac", 10, 10, 0)})).at(0).levels.at(0);
  EXPECT_THAT(level.methods.at("ransac").numbers.at("precision"), ElementsAre(0.5, 0));
  EXPECT_THAT(level.methods.at("ransac").numbers.at("time_ms"), ElementsAre(DoubleEq(2), IsNan()));
  EXPECT_EQ(level.methods.at("ransac").empty, 1);
}

TEST(LevelTable, KeepsTablesOfSeveralSizesOfAPairApart) {
  StudyRecord small = record_of("a", "gc", 10, 10, 10), large = record_of("a", "gc", 10, 10, 0);
  small.value = 300;
  large.value = 400;
  EXPECT_EQ(experiment_tables(run_of({small, large})).at(0).levels.at(0).count(PairRole::Judged), 2);
}

TEST(LevelTable, AMethodWithoutAnAnswerHasZeroAndIsNotEmpty) {
  StudyRecord refused = record_of("a", "st", 10, 0, 0);
  refused.status = {MethodState::TooLarge, "needs 9 GB"};
  refused.selected.reset();
  refused.recall = std::nullopt;
  refused.f1 = std::nullopt;
  const LevelTable level = experiment_tables(run_of({refused, record_of("a", "gc", 10, 1, 1)})).at(0).levels.at(0);
  EXPECT_EQ(mean_of(level.methods.at("st").numbers.at("precision")), 0);
  EXPECT_EQ(level.methods.at("st").empty, 0);
  EXPECT_EQ(level.methods.at("st").failed, 1);
  EXPECT_EQ(mean_of(level.methods.at("gc").numbers.at("precision")), 1);
  EXPECT_EQ(level.methods.at("gc").failed, 0);
}

TEST(LevelTable, OfAPairWithoutATruthOnlyWhatNeedsNoneIsThere) {
  StudyRecord unknown = record_of("a", "gc", 0, 5, 0);
  unknown.true_matches.reset();
  unknown.precision = std::nullopt;
  unknown.correct.reset();
  const LevelTable level = experiment_tables(run_of({unknown, record_of("b", "gc", 10, 1, 1)})).at(0).levels.at(0);
  EXPECT_THAT(level.roles, ElementsAre(PairRole::Unjudged, PairRole::Judged));
  const MethodColumns& columns = level.methods.at("gc");
  for (const char* name : {"precision", "recall", "f1", "correct", "success_5pr", "refined_mean_error_pr"})
    EXPECT_TRUE(std::isnan(columns.numbers.at(name)[0])) << name;
  EXPECT_THAT(columns.numbers.at("selected"), ElementsAre(5, 1));
}

// Keypoint radii may give tables of a pair that are equally large.
TEST(LevelTable, KeepsTablesOfOneSizeOfAPairApart) {
  std::vector<StudyRecord> records;
  for (const int correct : {10, 0})
    for (const char* method : {"gc", "ransac"})
      for (const int repeat : {0, 1}) {
        records.push_back(record_of("a", method, 10, 10, correct));
        records.back().repeat = repeat;
        records.back().value = 100;
        records.back().selection = correct > 0 ? "first.csv" : "second.csv";
      }
  const LevelTable level = experiment_tables(run_of(records)).at(0).levels.at(0);
  EXPECT_EQ(level.count(PairRole::Judged), 2);
  EXPECT_THAT(level.selections, ElementsAre("first.csv", "second.csv"));
  for (const char* method : {"gc", "ransac"})
    EXPECT_THAT(level.methods.at(method).numbers.at("precision"), ElementsAre(1, 0));
}

// As where the number of matches is the level, and a pair has none as it failed.
TEST(LevelTable, PassesOverARecordWithoutALevel) {
  StudyRecord nowhere;
  nowhere.experiment = "noise";
  nowhere.pair = "b";
  nowhere.method = "gc";
  EXPECT_EQ(experiment_tables(run_of({nowhere, record_of("a", "gc", 10, 1, 1)})).at(0).levels.at(0).pairs.size(), 1u);
}

TEST(LevelTable, PosesAreJudgedStageByStage) {
  StudyRecord good = record_of("a", "gc", 10, 4, 4), none = record_of("b", "gc", 10, 4, 4);
  good.initial.mean_error_pr = 6;
  good.refined.mean_error_pr = 1;
  good.refined.rotation_error_deg = 2;
  const auto columns = [&] { return experiment_tables(run_of({good, none})).at(0).levels.at(0).methods.at("gc"); };
  EXPECT_THAT(columns().numbers.at("initial_success_5pr"), ElementsAre(0, 0));
  EXPECT_THAT(columns().numbers.at("success_5pr"), ElementsAre(1, 0));
  EXPECT_THAT(columns().numbers.at("success_area"), ElementsAre(DoubleEq(success_area({1.0})), 0));
  EXPECT_THAT(columns().numbers.at("refined_rotation_error_deg"),
              ElementsAre(2, std::numeric_limits<double>::infinity()));
  EXPECT_THAT(columns().numbers.at("dense_success_5pr"), ElementsAre(IsNan(), IsNan()));  // nobody tried
  good.dense.rotation_error_deg = 1;
  good.dense.mean_error_pr = 1;
  EXPECT_THAT(columns().numbers.at("dense_success_5pr"), ElementsAre(1, 0));
}

TEST(LevelTable, ALevelWithoutARowHasEmptyColumnsOfPairs) {
  const LevelTable level = experiment_tables(run_of({})).at(0).levels.at(0);
  for (const Measure* measure : measures_with(kOfPair)) EXPECT_TRUE(level.column(*measure, "")->empty());
  EXPECT_FALSE(level.column(measure("precision"), "gc"));
}

TEST(LevelTable, RefusesALevelThatTheManifestLacks) {
  StudyRecord stray = record_of("a", "gc", 10, 1, 1);
  stray.level = "0.7";
  EXPECT_THAT(testing::io_error_of([&] { experiment_tables(run_of({stray})); }), HasSubstr("0.7"));
}

TEST(LevelTable, MeansPassOverWhatIsAbsent) {
  const double absent = std::nan("");
  EXPECT_EQ(mean_of({1, absent, 4}), 2.5);
  EXPECT_EQ(mean_of({1, absent, 4}, {0, 1, 0, 2}), 2);
  EXPECT_EQ(median_of({5, absent, 1, 2}), 2);
  EXPECT_EQ(median_of({5, 1}), 3);
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(median_of({infinite, 1, 3}), 3);
  EXPECT_EQ(median_of({infinite, 1}), infinite);
  EXPECT_EQ(median_of({infinite, infinite, 1}), infinite);
  EXPECT_THAT(mean_of({absent}), IsNan());
  EXPECT_THAT(median_of({}), IsNan());
}

TEST(LevelTable, ComparesSelections) {
  const testing::ScratchFolder folder;
  testing::put_text(folder / "x.csv",
                    "source_keypoint,target_keypoint,residual_pr,ss,gc,si,oracle\n"
                    "0,0,,1,1,0,0\n1,1,,1,0,0,0\n2,2,,0,1,0,1\n");
  StudyFolder run = run_of({record_of("a", "gc", 10, 1, 1), record_of("b", "gc", 10, 1, 1)});
  run.folder = folder.path();
  run.records[0].selection = "x.csv";
  const auto agreements = selection_agreement(run, experiment_tables(run).at(0), {"ss", "gc", "si"});
  // ss and gc share 1 of 3 rows, si shares none with either
  EXPECT_THAT(agreements.at(0), ElementsAre(DoubleEq((1.0 / 3 + 0 + 0) / 3), IsNan()));
}

// Whole pairs in parts of any size: the tables of the whole, with the measures that no part has left out.
TEST(TableBuilder, PartsGiveWhatTheWholeGives) {
  StudyFolder run = testing::simulated_study(1, 4);
  run.records.front().dense.mean_error_pr = 1;  // tried, in one part
  const std::vector<ExperimentTable> whole = experiment_tables(run);
  ASSERT_FALSE(whole.empty());
  for (std::size_t experiment = 0; experiment < whole.size(); ++experiment)
    for (const std::size_t least : {1u, 40u}) {
      const auto is_of_it = [&](const StudyRecord& record) {
        return record.experiment == run.experiments[experiment].name;
      };
      std::set<std::string> tried;
      for (const StudyRecord& record : run.records)
        if (is_of_it(record)) add_tried({record}, tried);
      TableBuilder builder(run.experiments[experiment], tried);
      std::vector<StudyRecord> part;
      for (const StudyRecord& record : run.records) {
        if (!is_of_it(record)) continue;
        if (part.size() >= least && !(part.back().pair == record.pair && part.back().level == record.level))
          builder.add(std::exchange(part, {}));
        part.push_back(record);
      }
      builder.add(std::move(part));
      const ExperimentTable table = std::move(builder).table();
      EXPECT_EQ(summary_text(summarize({table})), summary_text(summarize({whole[experiment]})));
      for (std::size_t level = 0; level < table.levels.size(); ++level) {
        EXPECT_EQ(table.levels[level].pairs, whole[experiment].levels[level].pairs);
        EXPECT_EQ(table.levels[level].scenes, whole[experiment].levels[level].scenes);
        EXPECT_EQ(table.levels[level].selections, whole[experiment].levels[level].selections);
        EXPECT_EQ(table.levels[level].roles, whole[experiment].levels[level].roles);
        EXPECT_EQ(table.levels[level].methods.size(), whole[experiment].levels[level].methods.size());
      }
    }
}

}  // namespace
}  // namespace corral
