// SPDX-License-Identifier: MIT
#include "apps/results/summary.h"

#include <cmath>
#include <limits>

#include "apps/results/comparison.h"
#include "io/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

/// Of the rows that count.
std::optional<double> counted_mean(const LevelTable& level, RowNumbers column) {
  for (std::size_t row = 0; row < column.size(); ++row)
    if (!level.counts[row]) column[row] = std::numeric_limits<double>::quiet_NaN();
  return finite(mean_of(column));
}

SummaryRow row_of(const ExperimentInfo& info, const LevelTable& level, const std::string& method) {
  SummaryRow row;
  row.experiment = info.name, row.dataset = info.dataset, row.level = level.level.label, row.method = method;
  row.excluded = level.excluded;
  row.failed = level.failed;
  const auto found = level.methods.find(method);
  if (found == level.methods.end()) return row;
  const MethodColumns& columns = found->second;
  row.pairs = present_in(columns.precision);
  row.empty = columns.empty;
  row.failed += columns.failed;
  const auto mean = [&](Metric metric) { return level_mean(info.name, level, method, metric); };
  row.precision = mean(Metric::Precision);
  row.recall = mean(Metric::Recall);
  row.f1 = mean(Metric::F1);
  row.success = mean(Metric::Success);
  row.pooled_precision = finite(pooled_precision(level, method));
  row.pooled_recall = finite(pooled_recall(level, method));
  row.precision_nonempty = finite(mean_of(columns.nonempty_precision));
  row.inlier_ratio = counted_mean(level, level.inlier_ratio);
  row.frame_share = counted_mean(level, level.frame_share);
  row.rotation_error_deg = finite(median_of(columns.rotation_error_deg));
  row.translation_error_pr = finite(median_of(columns.translation_error_pr));
  row.mean_error_pr = finite(median_of(columns.mean_error_pr));
  row.success_area = finite(mean_of(columns.success_area));
  row.initial_success = finite(mean_of(columns.initial_success));
  row.dense_success = finite(mean_of(columns.dense_success));
  return row;
}

const std::vector<std::string> kColumns = {"experiment",
                                           "dataset",
                                           "level",
                                           "method",
                                           "pairs",
                                           "excluded",
                                           "empty",
                                           "precision",
                                           "recall",
                                           "f1",
                                           "success_5pr",
                                           "failed",
                                           "pooled_precision",
                                           "pooled_recall",
                                           "precision_nonempty",
                                           "inlier_ratio",
                                           "frame_share",
                                           "refined_rotation_error_deg",
                                           "refined_translation_error_pr",
                                           "refined_mean_error_pr",
                                           "success_area",
                                           "initial_success_5pr",
                                           "dense_success_5pr",
                                           "precision_low",
                                           "precision_high",
                                           "recall_low",
                                           "recall_high",
                                           "f1_low",
                                           "f1_high",
                                           "success_5pr_low",
                                           "success_5pr_high"};

std::string row_text(const SummaryRow& row) {
  std::vector<std::string> cells = {row.experiment,
                                    row.dataset,
                                    row.level,
                                    row.method,
                                    std::to_string(row.pairs),
                                    std::to_string(row.excluded),
                                    std::to_string(row.empty)};
  const auto put = [&](const std::optional<double>& value) { cells.push_back(value ? to_text(*value) : ""); };
  const auto intervals = {&row.precision, &row.recall, &row.f1, &row.success};
  for (const auto* interval : intervals) cells.push_back(*interval ? to_text((*interval)->mean) : "");
  cells.push_back(std::to_string(row.failed));
  for (const auto& value : {row.pooled_precision, row.pooled_recall, row.precision_nonempty, row.inlier_ratio,
                            row.frame_share, row.rotation_error_deg, row.translation_error_pr, row.mean_error_pr,
                            row.success_area, row.initial_success, row.dense_success})
    put(value);
  for (const auto* interval : intervals) {
    cells.push_back(*interval ? to_text((*interval)->low) : "");
    cells.push_back(*interval ? to_text((*interval)->high) : "");
  }
  return csv_line(cells);
}

}  // namespace

std::vector<SummaryRow> summarize(const std::vector<ExperimentTable>& tables) {
  std::vector<SummaryRow> rows;
  for (const ExperimentTable& table : tables) {
    std::vector<std::string> methods = table.info.methods;
    methods.insert(methods.end(), {"oracle", "floor"});
    for (const LevelTable& level : table.levels)
      for (const std::string& method : methods) rows.push_back(row_of(table.info, level, method));
  }
  return rows;
}

std::string summary_text(const std::vector<SummaryRow>& rows) {
  std::string text = csv_line(kColumns);
  for (const SummaryRow& row : rows) text += row_text(row);
  return text;
}

}  // namespace corral
