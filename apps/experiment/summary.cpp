// SPDX-License-Identifier: MIT
#include "apps/experiment/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "io/csv_file.h"
#include "kernel/evaluation.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

using Errors = std::vector<std::optional<double>>;

/// Mean of what is added.
struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) { sum += value, ++count; }
  void add(const std::optional<double>& value) {
    if (value) add(*value);
  }
  std::optional<double> value() const { return count > 0 ? std::optional<double>(sum / count) : std::nullopt; }
};

std::optional<double> ratio(double part, double whole) {
  return whole > 0 ? std::optional<double>(part / whole) : std::nullopt;
}

/// The lower of two middle ones is averaged with the upper; absent errors are the largest, and have no value.
std::optional<double> median(const Errors& errors) {
  if (errors.empty()) return std::nullopt;
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.value_or(std::numeric_limits<double>::infinity()));
  std::sort(values.begin(), values.end());
  const double middle = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  return std::isfinite(middle) ? std::optional<double>(middle) : std::nullopt;
}

/// Share of samples whose error is at most 5 pr, each the mean over its repeats.
std::optional<double> success(const std::vector<Errors>& samples, bool is_known) {
  Mean mean;
  for (const Errors& repeats : samples) mean.add(success_curve(repeats, {success_thresholds_pr().back()}).front());
  return is_known ? mean.value() : std::nullopt;
}

/// Gathers the records of one method at one level, pair by pair.
class Gatherer {
 public:
  explicit Gatherer(int least_true_matches) : least_true_matches_(least_true_matches) {}

  /// The repeats of one pair.
  void add(const std::vector<const StudyRecord*>& repeats, SummaryRow& row) {
    const StudyRecord& first = *repeats.front();
    const auto failed = [](const StudyRecord* record) { return !record->selected; };
    if (!first.matches) return void(++row.failed);
    if (first.true_matches.value_or(-1) < least_true_matches_) return void(++row.excluded);
    ++row.pairs;
    row.failed += std::any_of(repeats.begin(), repeats.end(), failed);
    row.empty +=
        std::any_of(repeats.begin(), repeats.end(), [](const StudyRecord* record) { return record->selected == 0; });
    Mean precision, recall, f1, nonempty;
    std::vector<Errors*> poses = {&initial_.emplace_back(), &refined_.emplace_back(), &dense_.emplace_back()};
    for (const StudyRecord* record : repeats) {
      precision.add(record->precision.value_or(0));
      nonempty.add(record->precision);
      recall.add(record->recall.value_or(0));
      f1.add(record->f1.value_or(0));
      correct_ += record->correct.value_or(0);
      selected_ += record->selected.value_or(0);
      right_ += *record->true_matches;
      poses[0]->push_back(record->initial.rmse_pr);
      poses[1]->push_back(record->refined.rmse_pr);
      poses[2]->push_back(record->dense.rmse_pr);
      rotation_.push_back(record->refined.rotation_error_deg);
      translation_.push_back(record->refined.translation_error_pr);
      has_dense_ = has_dense_ || record->dense.rotation_error_deg;
    }
    precision_.add(precision.value());
    recall_.add(recall.value());
    f1_.add(f1.value());
    nonempty_.add(nonempty.value());
    inlier_ratio_.add(static_cast<double>(*first.true_matches) / std::max(*first.matches, 1));
    frame_share_.add(first.frame_share);
  }

  void finish(SummaryRow& row) const {
    row.precision = precision_.value();
    row.recall = recall_.value();
    row.f1 = f1_.value();
    row.success = success(refined_, true);
    row.pooled_precision = ratio(correct_, selected_);
    row.pooled_recall = ratio(correct_, right_);
    row.precision_nonempty = nonempty_.value();
    row.inlier_ratio = inlier_ratio_.value();
    row.frame_share = frame_share_.value();
    row.rotation_error_deg = median(rotation_);
    row.translation_error_pr = median(translation_);
    Errors all;
    Mean area;
    for (const Errors& repeats : refined_) {
      all.insert(all.end(), repeats.begin(), repeats.end());
      area.add(success_area(repeats));
    }
    row.rmse_pr = median(all);
    row.success_area = area.value();
    row.initial_success = success(initial_, true);
    row.dense_success = success(dense_, has_dense_);
  }

 private:
  int least_true_matches_;
  Mean precision_, recall_, f1_, nonempty_, inlier_ratio_, frame_share_;
  double correct_ = 0, selected_ = 0, right_ = 0;
  std::vector<Errors> initial_, refined_, dense_;
  Errors rotation_, translation_;
  bool has_dense_ = false;
};

using CellKey = std::tuple<std::string, std::string, std::string>;  // experiment, level, method

/// The repeats of each pair, by where they belong.
std::map<CellKey, std::vector<std::vector<const StudyRecord*>>> by_cell(const std::vector<StudyRecord>& records) {
  std::map<CellKey, std::vector<std::vector<const StudyRecord*>>> cells;
  for (const StudyRecord& record : records) {
    auto& samples = cells[{record.experiment, record.level, record.method}];
    if (record.repeat == 0 || samples.empty()) samples.emplace_back();
    samples.back().push_back(&record);
  }
  return cells;
}

}  // namespace

std::vector<SummaryRow> summarize(const std::vector<ExperimentInfo>& experiments,
                                  const std::vector<StudyRecord>& records) {
  const auto cells = by_cell(records);
  std::vector<SummaryRow> rows;
  for (const ExperimentInfo& info : experiments) {
    std::vector<std::string> methods = info.methods;
    methods.insert(methods.end(), {"oracle", "floor"});
    for (const StudyLevel& level : info.levels)
      for (const std::string& method : methods) {
        SummaryRow row;
        row.experiment = info.name, row.dataset = info.dataset, row.level = level.label, row.method = method;
        Gatherer gatherer(info.least_true_matches);
        const auto found = cells.find({info.name, level.label, method});
        if (found != cells.end())
          for (const auto& repeats : found->second) gatherer.add(repeats, row);
        gatherer.finish(row);
        rows.push_back(std::move(row));
      }
  }
  return rows;
}

std::string summary_text(const std::vector<SummaryRow>& rows) {
  std::string text = csv_line({"experiment",
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
                               "refined_rmse_pr",
                               "success_area",
                               "initial_success_5pr",
                               "dense_success_5pr"});
  for (const SummaryRow& row : rows) {
    std::vector<std::string> cells = {row.experiment,
                                      row.dataset,
                                      row.level,
                                      row.method,
                                      std::to_string(row.pairs),
                                      std::to_string(row.excluded),
                                      std::to_string(row.empty)};
    const auto put = [&](const std::optional<double>& value) {
      cells.push_back(value ? to_text(*value) : std::string());
    };
    for (const auto& value : {row.precision, row.recall, row.f1, row.success}) put(value);
    cells.push_back(std::to_string(row.failed));
    for (const auto& value : {row.pooled_precision, row.pooled_recall, row.precision_nonempty, row.inlier_ratio,
                              row.frame_share, row.rotation_error_deg, row.translation_error_pr, row.rmse_pr,
                              row.success_area, row.initial_success, row.dense_success})
      put(value);
    text += csv_line(cells);
  }
  return text;
}

}  // namespace corral
