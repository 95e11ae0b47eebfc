// SPDX-License-Identifier: MIT
#include "apps/results/losses.h"

#include <algorithm>

#include "apps/results/measures.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr const char* kNames[kStages] = {"registered", "keypoints", "matches", "grouping", "pose", "truth", "failed"};

using Records = std::vector<StudyRecord>::const_iterator;

/// The end of the records of a pair at a level. Another table of the same pair begins with the same method again.
Records end_of_pair(Records first, Records last) {
  const auto is_other = [&](const StudyRecord& record) {
    return !(record.experiment == first->experiment && record.level == first->level && record.pair == first->pair) ||
           record.value != first->value || (record.repeat == 0 && record.method == first->method);
  };
  return std::find_if(first + 1, last, is_other);
}

bool is_registering(const PoseScores& pose) { return pose.mean_error_pr && *pose.mean_error_pr <= kSuccessPr; }

PairEnd end_of(const StudyRecord& record) {
  return {is_registering(record.initial), is_registering(record.refined), record.status.state,
          record.correct.value_or(0), record.precision.value_or(0)};
}

Cause cause_of_pair(const StudyRecord& oracle) {
  return cause_of(PairState{role_of(oracle, 0) != PairRole::Misfit, is_registering(oracle.refined), false,
                            oracle.keypoints_in_overlap});
}

}  // namespace

const char* to_text(Stage stage) { return kNames[static_cast<std::size_t>(stage)]; }

Stage stage_of(Cause cause) {
  switch (cause) {
    case Cause::Found:
    case Cause::Saved:
      return Stage::Registered;
    case Cause::TruthDoesNotFit:
      return Stage::Truth;
    case Cause::TooFewKeypoints:
      return Stage::Keypoints;
    case Cause::NormalsOpposed:
    case Cause::TooFewTrueMatches:
      return Stage::Matches;
    case Cause::GrouperMissed:
    case Cause::DegenerateSelection:
      return Stage::Grouping;
    case Cause::Diverged:
    case Cause::NotConverged:
    case Cause::Spoiled:
      return Stage::Pose;
    case Cause::NoAnswer:
      break;
  }
  return Stage::Failed;
}

LossCounter::LossCounter(const std::vector<ExperimentInfo>& experiments) {
  for (const ExperimentInfo& info : experiments) {
    std::vector<std::string> methods = info.methods;
    methods.insert(methods.end(), {"oracle", "baseline"});
    for (const StudyLevel& level : info.levels) {
      levels_[{info.name, level.label}] = rows_.size();
      for (const std::string& method : methods) rows_.push_back({info.name, info.dataset, level.label, method});
    }
  }
}

void LossCounter::add(const std::vector<StudyRecord>& records) {
  for (Records first = records.begin(); first != records.end();) {
    const Records last = end_of_pair(first, records.end());
    add_pair(first, last);
    first = last;
  }
}

void LossCounter::add_pair(Records first, Records last) {
  const auto oracle = std::find_if(first, last, [](const StudyRecord& record) { return record.method == "oracle"; });
  const auto level = levels_.find({first->experiment, first->level});
  if (oracle == last || level == levels_.end()) return;  // without a truth, or at no level
  const Cause pair = cause_of_pair(*oracle);
  for (auto record = first; record != last; ++record) {
    if (record->status.state == MethodState::NotApplicable) continue;
    const auto is_same = [&](const auto& other) { return record->method == other.method; };
    const auto row = std::find_if(rows_.begin() + static_cast<std::ptrdiff_t>(level->second), rows_.end(), is_same);
    if (row == rows_.end() || row->experiment != first->experiment || row->level != first->level.str()) continue;
    row->pairs += record->repeat == 0;
    const Cause cause = pair == Cause::TruthDoesNotFit ? pair : cause_of(end_of(*record), pair);
    row->ended[static_cast<std::size_t>(stage_of(cause))] +=
        1.0 / static_cast<double>(std::count_if(first, last, is_same));
  }
}

std::vector<LossRow> losses_of(const StudyFolder& run) {
  LossCounter losses(run.experiments);
  losses.add(run.records);
  return losses.rows();
}

std::vector<LossRow> over_levels(const std::vector<LossRow>& rows) {
  std::vector<LossRow> sums;
  for (const LossRow& row : rows) {
    const auto is_same = [&](const LossRow& sum) {
      return sum.experiment == row.experiment && sum.method == row.method;
    };
    auto sum = std::find_if(sums.begin(), sums.end(), is_same);
    if (sum == sums.end()) sum = sums.insert(sum, {row.experiment, row.dataset, "", row.method});
    sum->pairs += row.pairs;
    for (std::size_t stage = 0; stage < kStages; ++stage) sum->ended[stage] += row.ended[stage];
  }
  return sums;
}

std::string losses_text(const std::vector<LossRow>& rows) {
  std::vector<std::string> header = {"experiment", "dataset", "level", "method", "pairs"};
  header.insert(header.end(), std::begin(kNames), std::end(kNames));
  std::string text = csv_line(header);
  for (const LossRow& row : rows) {
    std::vector<std::string> cells = {row.experiment, row.dataset, row.level, row.method, std::to_string(row.pairs)};
    for (std::size_t stage = 0; stage < kStages; ++stage)
      cells.push_back(row.pairs > 0 ? to_text(row.share(static_cast<Stage>(stage))) : "");
    text += csv_line(cells);
  }
  return text;
}

}  // namespace corral
