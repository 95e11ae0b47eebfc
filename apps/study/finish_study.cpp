// SPDX-License-Identifier: MIT
#include "apps/study/finish_study.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>

#include "apps/pair/truth_fit.h"
#include "apps/study/assemble.h"
#include "apps/study/manifest.h"
#include "io/disk/file.h"
#include "io/disk/staged_files.h"

namespace corral {
namespace {

template <class Row>
void append(std::vector<Row> rows, std::vector<Row>& all) {
  std::move(rows.begin(), rows.end(), std::back_inserter(all));
}

/// What is wrong with the data of the pairs, each pair once, in the order of the units.
void add_warnings(const WorkList& list, const std::vector<std::size_t>& units, const std::vector<UnitResult>& results,
                  StudyOutcome& outcome) {
  std::set<std::string> named;
  for (const std::size_t unit : units) {
    const DatasetPair& pair = list.units[unit].pair;
    const std::string& verdict = results[unit].truth;
    const auto add = [&](const std::string& text, std::vector<std::string>& lines) {
      const std::string line = "pair " + pair.name + ": " + text;
      if (named.insert(pair.truth + " " + line).second) lines.push_back(line);
    };
    if (!verdict.empty() && !TruthFit::is_belonging(verdict))
      add(pair.truth + ": " + results[unit].truth_text, outcome.misfits);
    for (const std::string& warning : results[unit].warnings) add(warning, outcome.warnings);
  }
}

/// Averages the records of an experiment level by level, as they come: the numbers of one level are in memory at a time.
class LevelSummary {
 public:
  LevelSummary(const ExperimentInfo& info, std::set<std::string> tried) : info_(info), tried_(std::move(tried)) {
    begin();
  }
  void add(int level, std::vector<StudyRecord> records) {
    while (level_ < level) end(), begin();
    if (level >= 0) table_->add(std::move(records));
  }
  std::vector<SummaryRow> rows() && {
    while (static_cast<std::size_t>(level_) < info_.levels.size()) end(), begin();
    return std::move(rows_);
  }

 private:
  void begin() {
    if (static_cast<std::size_t>(level_) == info_.levels.size()) return;
    ExperimentInfo info = info_;
    info.levels = {info_.levels[static_cast<std::size_t>(level_)]};
    table_.emplace(std::move(info), tried_);
  }
  void end() {
    std::vector<ExperimentTable> tables;
    tables.push_back(std::move(*table_).table());
    append(summarize(tables), rows_);
    ++level_;
  }

  const ExperimentInfo& info_;
  const std::set<std::string> tried_;
  int level_ = 0;
  std::optional<TableBuilder> table_;
  std::vector<SummaryRow> rows_;
};

/// Writes the records, and averages and counts them, one experiment after the other.
void write_records(const WorkList& list, const std::vector<UnitResult>& results, StagedFiles& files,
                   StudyOutcome& outcome) {
  files.write(records_header());
  for (std::size_t number = 0; number < list.experiments.size(); ++number) {
    const ExperimentInfo& info = list.experiments[number].info;
    const int experiment = static_cast<int>(number);
    std::set<std::string> tried;
    assemble_records(list, results, experiment, [&](int, const auto& records) { add_tried(records, tried); });
    LossCounter losses({info});
    LevelSummary summary(info, std::move(tried));
    assemble_records(list, results, experiment, [&](int level, std::vector<StudyRecord> records) {
      files.write(records_text(records));
      losses.add(records);
      summary.add(level, std::move(records));
    });
    append(std::move(summary).rows(), outcome.summary);
    append(losses.rows(), outcome.losses);
  }
}

}  // namespace

bool has_failed(const UnitResult& result) {
  return !result.failure.empty() || std::any_of(result.tasks.begin(), result.tasks.end(), [](const TaskResult& task) {
    return !task.selected && task.status.state != MethodState::NotApplicable;
  });
}

StudyOutcome outcome_of(const WorkList& list, const FinishedUnits& finished, const std::vector<std::size_t>& units) {
  StudyOutcome outcome;
  outcome.units = units.size();
  outcome.failed = static_cast<std::size_t>(std::count_if(
      units.begin(), units.end(), [&](std::size_t unit) { return has_failed(finished.results()[unit]); }));
  add_warnings(list, units, finished.results(), outcome);
  return outcome;
}

StudyOutcome finish_study(const WorkList& list, const FinishedUnits& finished, const std::string& folder,
                          const std::string& command_line) {
  std::vector<std::size_t> all(list.units.size());
  std::iota(all.begin(), all.end(), 0);
  StudyOutcome outcome = outcome_of(list, finished, all);
  const auto place = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  for (const char* name : {"records.csv", "summary.csv", "manifest.json"}) remove_leftovers_of(place(name));
  StagedFiles files;
  files.begin(place("records.csv"));
  write_records(list, finished.results(), files, outcome);
  files.begin(place("summary.csv"));
  files.write(summary_text(outcome.summary));
  files.begin(place("manifest.json"));
  files.write(manifest_text(list, finished.inputs(), {finished.results(), finished.machines(), command_line}));
  files.commit();
  remove_leftovers(place("selections"));  // of calls that were killed
  return outcome;
}

}  // namespace corral
