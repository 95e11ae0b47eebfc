// SPDX-License-Identifier: MIT
#include "apps/study/assemble.h"

#include <algorithm>

#include "io/csv_file.h"

namespace corral {
namespace {

/// What all rows of a sample have in common.
StudyRecord common_part(const WorkList& list, const StudySample& sample, const UnitResult& result) {
  const ExperimentInfo& info = list.experiments[static_cast<std::size_t>(sample.experiment)].info;
  StudyRecord record;
  record.experiment = info.name;
  record.dataset = info.dataset;
  record.level = sample.level < 0 ? std::string() : info.levels[static_cast<std::size_t>(sample.level)].label;
  record.pair = list.units[static_cast<std::size_t>(sample.unit)].pair.name;
  record.scene = list.units[static_cast<std::size_t>(sample.unit)].scene;
  record.value = sample.value;
  if (result.failure.empty()) record.matches = result.matches;
  if (result.failure.empty() && list.units[static_cast<std::size_t>(sample.unit)].is_in_metres)
    record.metres_per_pr = result.resolution;
  return record;
}

/// Which of the unit's thresholds the sample is scored at.
std::size_t threshold_of(const WorkList& list, const StudySample& sample) {
  const auto& thresholds = list.units[static_cast<std::size_t>(sample.unit)].thresholds_pr;
  return static_cast<std::size_t>(std::find(thresholds.begin(), thresholds.end(), sample.threshold_pr) -
                                  thresholds.begin());
}

/// The number of matches, or the percentage of correct ones among them; absent without a truth.
std::optional<double> measured_value(const WorkList& list, const StudySample& sample, const UnitResult& result) {
  if (list.experiments[static_cast<std::size_t>(sample.experiment)].sweep == Sweep::Matches) return result.matches;
  if (!result.has_truth || result.matches == 0) return std::nullopt;
  return 100.0 * result.true_matches[threshold_of(list, sample)] / result.matches;
}

StudyRecord scored(StudyRecord record, const TaskResult& task, std::size_t threshold) {
  record.status = task.status;
  record.selected = task.selected;
  record.initial = task.initial;
  record.refined = task.refined;
  record.all_rows = task.all_rows;
  record.dense = task.dense;
  record.time_ms = task.time_ms;
  record.stated_time_ms = task.stated_time_ms;
  if (task.correct.empty() || !task.selected) return record;
  const int correct = task.correct[threshold];
  const int right = task.true_matches.empty() ? *record.true_matches : task.true_matches[threshold];
  record.correct = correct;
  if (*task.selected > 0) record.precision = static_cast<double>(correct) / *task.selected;
  if (right == 0) return record;
  record.recall = static_cast<double>(correct) / right;
  record.f1 = 2.0 * correct / (*task.selected + right);
  return record;
}

void add_rows(const WorkList& list, const StudySample& sample, const UnitResult& result,
              std::vector<StudyRecord>& records) {
  const WorkUnit& unit = list.units[static_cast<std::size_t>(sample.unit)];
  const std::size_t threshold = threshold_of(list, sample);
  StudyRecord common = common_part(list, sample, result);
  if (!result.failure.empty()) common.status = {MethodState::Failed, result.failure};
  if (result.has_truth) {
    common.truth = result.truth;
    common.keypoints_in_overlap = result.keypoints_in_overlap;
    common.true_matches = result.true_matches[threshold];
    common.frame_share = result.frame_share[threshold];
  }
  for (const int task : sample.tasks) {
    StudyRecord record = common;
    record.method = unit.tasks[static_cast<std::size_t>(task)].method;
    record.repeat = unit.tasks[static_cast<std::size_t>(task)].repeat;
    if (result.failure.empty()) {
      record = scored(std::move(record), result.tasks[static_cast<std::size_t>(task)], threshold);
      if (record.repeat == 0) record.selection = sample.selection;
    }
    records.push_back(std::move(record));
  }
  if (result.failure.empty() && !result.has_truth) return;
  if (!result.failure.empty() && unit.pair.truth.empty()) return;
  for (const char* bound : {"oracle", "baseline"}) {
    StudyRecord record = common;
    record.method = bound;
    if (result.failure.empty())
      record = scored(std::move(record), record.method == "baseline" ? *result.baseline : result.oracles[threshold],
                      threshold);
    records.push_back(std::move(record));
  }
}

}  // namespace

std::vector<StudyRecord> assemble_records(const WorkList& list, const std::vector<UnitResult>& results) {
  std::vector<StudySample> samples;
  for (StudySample sample : list.samples) {
    const Experiment& experiment = list.experiments[static_cast<std::size_t>(sample.experiment)];
    const UnitResult& result = results[static_cast<std::size_t>(sample.unit)];
    if (is_measured(experiment.sweep) && result.failure.empty()) {
      sample.value = measured_value(list, sample, result);
      sample.level = sample.value ? level_of(experiment.info.levels, *sample.value) : -1;
      if (sample.level < 0) continue;
    }
    samples.push_back(std::move(sample));
  }
  std::stable_sort(samples.begin(), samples.end(), [](const StudySample& a, const StudySample& b) {
    return std::tie(a.experiment, a.level) < std::tie(b.experiment, b.level);
  });
  std::vector<StudyRecord> records;
  for (const StudySample& sample : samples)
    add_rows(list, sample, results[static_cast<std::size_t>(sample.unit)], records);
  return records;
}

std::string records_text(const std::vector<StudyRecord>& records) {
  std::string text = csv_line(record_columns());
  for (const StudyRecord& record : records) text += record_line(record);
  return text;
}

}  // namespace corral
