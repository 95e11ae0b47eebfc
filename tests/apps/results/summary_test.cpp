// SPDX-License-Identifier: MIT
#include "apps/results/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/results/comparison.h"
#include "apps/runtime/workers.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"
#include "tests/io/scratch.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using testing::put_text;
using testing::ScratchFolder;
using ::testing::StartsWith;

ExperimentInfo info_of(int least_true_matches = 1) {
  ExperimentInfo info;
  info.name = "e", info.dataset = "d", info.methods = {"gc"}, info.least_true_matches = least_true_matches;
  info.levels = {{"1", 1, 1}, {"2", 2, 2}};
  return info;
}

/// A pair with 10 matches of which `right` are right, `correct` of the `selected` among them.
StudyRecord record_of(const std::string& pair, int right, int selected, int correct,
                      std::optional<double> mean_error_pr) {
  StudyRecord record;
  record.experiment = "e", record.dataset = "d", record.level = "1", record.pair = pair, record.method = "gc";
  record.status = {MethodState::Refined}, record.matches = 10, record.true_matches = right;
  record.selected = selected, record.correct = correct, record.refined.mean_error_pr = mean_error_pr;
  if (selected > 0) record.precision = static_cast<double>(correct) / selected;
  if (right > 0) record.recall = static_cast<double>(correct) / right, record.f1 = 2.0 * correct / (selected + right);
  return record;
}

std::vector<SummaryRow> rows_of(const std::vector<StudyRecord>& records, int least_true_matches = 1) {
  return summarize(experiment_tables({"", {info_of(least_true_matches)}, {}, records}));
}

SummaryRow first_row(const std::vector<StudyRecord>& records, int least_true_matches = 1) {
  return rows_of(records, least_true_matches).front();
}

// Worked out on paper: four pairs with P = 1/2, 1, 0 (empty), 0; R = 1/2, 1/4, 0, 0; F1 = 1/2, 2/5, 0, 0.
TEST(Summary, IsTheMeanOverPairs) {
  const SummaryRow row =
      first_row({record_of("a", 4, 4, 2, 5), record_of("b", 4, 1, 1, 5.01), record_of("c", 2, 0, 0, {}),
                 record_of("d", 2, 5, 0, 1), record_of("excluded", 0, 3, 0, 0.1)});
  EXPECT_EQ(row.pairs, 4);
  EXPECT_EQ(row.excluded, 1);
  EXPECT_EQ(row.empty, 1);
  EXPECT_EQ(row.failed, 0);
  EXPECT_DOUBLE_EQ(*row.of("precision").value, 1.5 / 4);
  EXPECT_DOUBLE_EQ(*row.of("recall").value, 0.75 / 4);
  EXPECT_DOUBLE_EQ(*row.of("f1").value, 0.9 / 4);
  EXPECT_DOUBLE_EQ(*row.of("precision_nonempty").value, 1.5 / 3);
  EXPECT_DOUBLE_EQ(*row.of("pooled_precision").value, 3.0 / 10);
  EXPECT_DOUBLE_EQ(*row.of("pooled_recall").value, 3.0 / 12);
  EXPECT_DOUBLE_EQ(*row.of("inlier_ratio").value, 1.2 / 4);
  EXPECT_DOUBLE_EQ(*row.of("success_5pr").value,
                   0.5);  // 5 is a success, 5.01 and no pose are none, the excluded pair counts nowhere
  EXPECT_DOUBLE_EQ(*row.of("refined_mean_error_pr").value, (5 + 5.01) / 2);
  EXPECT_FALSE(row.of("dense_success_5pr").value);
}

TEST(Summary, FewerRightMatchesThanAskedForExcludeThePair) {
  const std::vector<StudyRecord> records = {record_of("a", 2, 2, 2, 1), record_of("b", 3, 1, 0, 1)};
  EXPECT_EQ(first_row(records, 3).excluded, 1);
  EXPECT_DOUBLE_EQ(first_row(records, 3).of("precision").value.value(), 0);
  EXPECT_DOUBLE_EQ(first_row(records, 2).of("precision").value.value(), 0.5);
}

TEST(Summary, RepeatsOfAPairCountAsOne) {
  StudyRecord again = record_of("a", 4, 4, 4, {});
  again.repeat = 1;
  const SummaryRow row = first_row({record_of("a", 4, 4, 0, 1), again, record_of("b", 4, 4, 4, 1)});
  EXPECT_EQ(row.pairs, 2);
  EXPECT_DOUBLE_EQ(*row.of("precision").value, 0.75);
  EXPECT_DOUBLE_EQ(*row.of("success_5pr").value, 0.75);
}

TEST(Summary, AFailedMethodSelectsNothingAndAFailedPairCountsNowhere) {
  StudyRecord method = record_of("a", 4, 0, 0, {}), pair = record_of("b", 0, 0, 0, {});
  method.selected = method.correct = std::nullopt;
  method.recall = method.f1 = std::nullopt, method.status = {MethodState::Failed, "so"};
  pair.matches = pair.true_matches = pair.selected = pair.correct = std::nullopt;
  pair.status = {MethodState::Failed, "no mesh"};
  const SummaryRow row = first_row({method, pair, record_of("c", 4, 4, 4, 1)});
  EXPECT_EQ(row.pairs, 2);
  EXPECT_EQ(row.failed, 2);
  EXPECT_EQ(row.empty, 0);
  EXPECT_EQ(row.excluded, 0);
  EXPECT_DOUBLE_EQ(*row.of("precision").value, 0.5);
  EXPECT_DOUBLE_EQ(*row.of("success_5pr").value, 0.5);
}

TEST(Summary, MediansTakeNoPoseForTheWorst) {
  const auto with_rotation = [](double degrees) {
    StudyRecord record = record_of("x", 4, 4, 4, 1);
    record.refined.rotation_error_deg = degrees;
    return record;
  };
  const StudyRecord none = record_of("y", 4, 0, 0, {});
  EXPECT_EQ(first_row({with_rotation(3), none, with_rotation(1)}).of("refined_rotation_error_deg").value, 3);
  EXPECT_FALSE(first_row({none, with_rotation(1)}).of("refined_rotation_error_deg").value);
}

TEST(Summary, APairWhoseTruthDoesNotFitIsCountedApartAndInNoMean) {
  StudyRecord fits = record_of("a", 4, 4, 4, 1), loose = record_of("b", 4, 4, 4, 1), wrong = record_of("c", 4, 4, 1, 9);
  fits.truth = "fits", loose.truth = "loose";
  for (const char* verdict : {"inverted", "misplaced", "translation times 0.001"}) {
    wrong.truth = verdict;
    const SummaryRow row = first_row({fits, loose, wrong});
    EXPECT_EQ(row.pairs, 2);
    EXPECT_EQ(row.misfit, 1);
    EXPECT_EQ(row.excluded, 0);
    EXPECT_EQ(row.of("precision").value, 1);
    EXPECT_EQ(row.of("success_5pr").value, 1);
  }
}

TEST(Summary, HasARowForEveryLevelAndMethodInOrder) {
  const auto rows = rows_of({record_of("a", 4, 4, 4, 1)});
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[1].method, "oracle");
  EXPECT_EQ(rows[3].level, "2");
  EXPECT_EQ(rows[3].pairs, 0);
  EXPECT_FALSE(rows[3].of("precision").value);
  EXPECT_THAT(
      summary_text(rows),
      StartsWith("experiment,dataset,level,method,pairs,excluded,misfit,empty,precision,recall,f1,success_5pr,"));
}

// What corral compare says of a level, cell by cell; nothing where there is nothing.
TEST(Summary, IntervalsAreThoseOfTheComparison) {
  std::vector<StudyRecord> records;
  for (int pair = 0; pair < 12; ++pair)
    records.push_back(record_of(std::to_string(pair), 10, 8, pair % 8, pair % 3 == 0 ? 9 : 1));
  const ScratchFolder folder;
  put_text(folder / "summary.csv", summary_text(rows_of(records)));
  const CsvTable summary = read_csv(folder / "summary.csv");
  const auto cell = [&](std::size_t row, const std::string& column) {
    return summary.rows[row][static_cast<std::size_t>(summary.column(column))];
  };
  const ExperimentTable table = experiment_tables({"", {info_of()}, {}, records}).at(0);
  for (const std::string name : {"precision", "recall", "f1", "success_5pr"}) {
    const MeanInterval mean = compare_methods(table, measure(name)).levels.at(0).mean;
    EXPECT_LT(mean.low, mean.mean);
    EXPECT_LT(mean.mean, mean.high);
    EXPECT_EQ(cell(0, name), to_text(mean.mean));
    EXPECT_EQ(cell(0, name + "_low"), to_text(mean.low));
    EXPECT_EQ(cell(0, name + "_high"), to_text(mean.high));
    EXPECT_EQ(cell(3, name) + cell(3, name + "_low") + cell(3, name + "_high"), "");  // a level without a pair
  }
}

TEST(Summary, IsTheSameForAnyNumberOfThreads) {
  const std::vector<ExperimentTable> tables = experiment_tables(testing::simulated_study(1, 4));
  EXPECT_EQ(summary_text(summarize(tables, workers(3))), summary_text(summarize(tables)));
}

TEST(Summary, WhatIsExcludedIsSoForAllMethods) {
  for (const SummaryRow& row : rows_of({record_of("a", 0, 3, 0, {})})) {
    EXPECT_EQ(row.excluded, row.level == "1" ? 1 : 0) << row.method;
    EXPECT_EQ(row.pairs + row.failed, 0);
    EXPECT_FALSE(row.of("inlier_ratio").value || row.of("success_5pr").value);
  }
}

// It counts as excluded, and lowers no mean.
TEST(Summary, APairWithoutATruthCountsOnlyWhereNoneIsNeeded) {
  StudyRecord unknown = record_of("a", 0, 3, 0, {}), unanswered = record_of("b", 0, 3, 0, {});
  for (StudyRecord* record : {&unknown, &unanswered})
    record->true_matches = record->correct = std::nullopt, record->precision = std::nullopt;
  unanswered.selected.reset();
  const SummaryRow row = first_row({unknown, unanswered, record_of("c", 4, 4, 2, 1)});
  EXPECT_EQ(row.pairs, 1);
  EXPECT_EQ(row.excluded, 2);
  EXPECT_EQ(row.failed, 1);  // that is seen without a truth
  for (const auto& [name, value] : {std::pair<std::string, double>{"precision", 0.5},
                                    {"success_5pr", 1},
                                    {"pooled_precision", 0.5},
                                    {"pooled_recall", 0.5},
                                    {"refined_mean_error_pr", 1}})
    EXPECT_EQ(row.of(name).value, value) << name;
}

}  // namespace
}  // namespace corral
