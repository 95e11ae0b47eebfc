// SPDX-License-Identifier: MIT
#include "apps/results/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/results/comparison.h"
#include "io/csv_file.h"
#include "kernel/number_text.h"
#include "tests/io/scratch.h"

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
  record.status = "refined", record.matches = 10, record.true_matches = right;
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
  EXPECT_DOUBLE_EQ(row.precision->mean, 1.5 / 4);
  EXPECT_DOUBLE_EQ(row.recall->mean, 0.75 / 4);
  EXPECT_DOUBLE_EQ(row.f1->mean, 0.9 / 4);
  EXPECT_DOUBLE_EQ(*row.precision_nonempty, 1.5 / 3);
  EXPECT_DOUBLE_EQ(*row.pooled_precision, 3.0 / 10);
  EXPECT_DOUBLE_EQ(*row.pooled_recall, 3.0 / 12);
  EXPECT_DOUBLE_EQ(*row.inlier_ratio, 1.2 / 4);
  EXPECT_DOUBLE_EQ(row.success->mean,
                   0.5);  // 5 is a success, 5.01 and no pose are none, the excluded pair counts nowhere
  EXPECT_DOUBLE_EQ(*row.mean_error_pr, (5 + 5.01) / 2);
  EXPECT_FALSE(row.dense_success);
}

TEST(Summary, FewerRightMatchesThanAskedForExcludeThePair) {
  const std::vector<StudyRecord> records = {record_of("a", 2, 2, 2, 1), record_of("b", 3, 1, 0, 1)};
  EXPECT_EQ(first_row(records, 3).excluded, 1);
  EXPECT_DOUBLE_EQ(first_row(records, 3).precision->mean, 0);
  EXPECT_DOUBLE_EQ(first_row(records, 2).precision->mean, 0.5);
}

TEST(Summary, RepeatsOfAPairCountAsOne) {
  StudyRecord again = record_of("a", 4, 4, 4, {});
  again.repeat = 1;
  const SummaryRow row = first_row({record_of("a", 4, 4, 0, 1), again, record_of("b", 4, 4, 4, 1)});
  EXPECT_EQ(row.pairs, 2);
  EXPECT_DOUBLE_EQ(row.precision->mean, 0.75);
  EXPECT_DOUBLE_EQ(row.success->mean, 0.75);
}

TEST(Summary, AFailedMethodSelectsNothingAndAFailedPairCountsNowhere) {
  StudyRecord method = record_of("a", 4, 0, 0, {}), pair = record_of("b", 0, 0, 0, {});
  method.selected = method.correct = std::nullopt;
  method.recall = method.f1 = std::nullopt, method.status = "failed: so";
  pair.matches = pair.true_matches = pair.selected = pair.correct = std::nullopt;
  pair.status = "failed: no mesh";
  const SummaryRow row = first_row({method, pair, record_of("c", 4, 4, 4, 1)});
  EXPECT_EQ(row.pairs, 2);
  EXPECT_EQ(row.failed, 2);
  EXPECT_EQ(row.empty, 0);
  EXPECT_EQ(row.excluded, 0);
  EXPECT_DOUBLE_EQ(row.precision->mean, 0.5);
  EXPECT_DOUBLE_EQ(row.success->mean, 0.5);
}

TEST(Summary, MediansTakeNoPoseForTheWorst) {
  const auto with_rotation = [](double degrees) {
    StudyRecord record = record_of("x", 4, 4, 4, 1);
    record.refined.rotation_error_deg = degrees;
    return record;
  };
  const StudyRecord none = record_of("y", 4, 0, 0, {});
  EXPECT_EQ(first_row({with_rotation(3), none, with_rotation(1)}).rotation_error_deg, 3);
  EXPECT_FALSE(first_row({none, with_rotation(1)}).rotation_error_deg);
}

TEST(Summary, HasARowForEveryLevelAndMethodInOrder) {
  const auto rows = rows_of({record_of("a", 4, 4, 4, 1)});
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[1].method, "oracle");
  EXPECT_EQ(rows[3].level, "2");
  EXPECT_EQ(rows[3].pairs, 0);
  EXPECT_FALSE(rows[3].precision);
  EXPECT_THAT(summary_text(rows),
              StartsWith("experiment,dataset,level,method,pairs,excluded,empty,precision,recall,f1,success_5pr,"));
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
  for (const auto& [metric, name] : {std::pair<Metric, std::string>{Metric::Precision, "precision"},
                                     {Metric::Recall, "recall"},
                                     {Metric::F1, "f1"},
                                     {Metric::Success, "success_5pr"}}) {
    const MeanInterval mean = compare_methods(table, metric).levels.at(0).mean;
    EXPECT_LT(mean.low, mean.mean);
    EXPECT_LT(mean.mean, mean.high);
    EXPECT_EQ(cell(0, name), to_text(mean.mean));
    EXPECT_EQ(cell(0, name + "_low"), to_text(mean.low));
    EXPECT_EQ(cell(0, name + "_high"), to_text(mean.high));
    EXPECT_EQ(cell(3, name) + cell(3, name + "_low") + cell(3, name + "_high"), "");  // a level without a pair
  }
}

TEST(Summary, WhatIsExcludedIsSoForAllMethods) {
  StudyRecord unknown = record_of("a", 0, 3, 0, {});
  unknown.true_matches = std::nullopt;
  for (const SummaryRow& row : rows_of({unknown})) {
    EXPECT_EQ(row.excluded, row.level == "1" ? 1 : 0) << row.method;
    EXPECT_EQ(row.pairs + row.failed, 0);
    EXPECT_FALSE(row.inlier_ratio || row.success);
  }
}

}  // namespace
}  // namespace corral
