// SPDX-License-Identifier: MIT
#include "apps/study/assemble.h"

#include <algorithm>

#include "io/text/csv_file.h"

namespace corral {
namespace {

constexpr std::size_t kSamplesAtOnce = 1000;

/// A sample with the level that it turned out to be at.
struct PlacedSample {
  const StudySample* sample;
  std::optional<double> value;
  int level;
};

/// What all rows of a sample have in common.
StudyRecord common_part(const WorkList& list, const PlacedSample& placed, const UnitResult& result) {
  const StudySample& sample = *placed.sample;
  const ExperimentInfo& info = list.experiments[static_cast<std::size_t>(sample.experiment)].info;
  StudyRecord record;
  record.experiment = info.name;
  record.dataset = info.dataset;
  record.level = placed.level < 0 ? std::string() : info.levels[static_cast<std::size_t>(placed.level)].label;
  record.pair = list.units[static_cast<std::size_t>(sample.unit)].pair.name;
  record.scene = list.units[static_cast<std::size_t>(sample.unit)].scene;
  record.value = placed.value;
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
  record.confidence = task.confidence;
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

void add_rows(const WorkList& list, const PlacedSample& placed, const UnitResult& result,
              std::vector<StudyRecord>& records) {
  const StudySample& sample = *placed.sample;
  const WorkUnit& unit = list.units[static_cast<std::size_t>(sample.unit)];
  const std::size_t threshold = threshold_of(list, sample);
  StudyRecord common = common_part(list, placed, result);
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
  for (const bool is_oracle : {true, false}) {
    StudyRecord record = common;
    record.method = is_oracle ? "oracle" : "baseline";
    if (result.failure.empty())
      record = scored(std::move(record), is_oracle ? result.oracles[threshold] : *result.baseline, threshold);
    records.push_back(std::move(record));
  }
}

/// The samples of an experiment that are at a level or failed, by level and unit.
std::vector<PlacedSample> placed_samples(const WorkList& list, const std::vector<UnitResult>& results, int experiment) {
  const Experiment& of = list.experiments[static_cast<std::size_t>(experiment)];
  std::vector<PlacedSample> placed;
  for (const StudySample& sample : list.samples) {
    if (sample.experiment != experiment) continue;
    PlacedSample place{&sample, sample.value, sample.level};
    const UnitResult& result = results[static_cast<std::size_t>(sample.unit)];
    if (is_measured(of.sweep) && result.failure.empty()) {
      place.value = measured_value(list, sample, result);
      place.level = place.value ? level_of(of.info.levels, *place.value) : -1;
      if (place.level < 0) continue;
    }
    placed.push_back(place);
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const PlacedSample& a, const PlacedSample& b) { return a.level < b.level; });
  return placed;
}

}  // namespace

void assemble_records(const WorkList& list, const std::vector<UnitResult>& results, int experiment,
                      const std::function<void(int level, std::vector<StudyRecord>)>& consume) {
  const std::vector<PlacedSample> placed = placed_samples(list, results, experiment);
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    const int level = placed[begin].level;
    std::vector<StudyRecord> records;
    for (; end < placed.size() && end - begin < kSamplesAtOnce && placed[end].level == level; ++end)
      add_rows(list, placed[end], results[static_cast<std::size_t>(placed[end].sample->unit)], records);
    consume(level, std::move(records));
  }
}

std::string records_text(const std::vector<StudyRecord>& records) {
  std::string text;
  for (const StudyRecord& record : records) text += record_line(record);
  return text;
}

std::string records_header() { return csv_line(record_columns()); }

}  // namespace corral
