// SPDX-License-Identifier: MIT
#include "apps/study/finish_study.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "apps/pair/truth_fit.h"
#include "apps/study/assemble.h"
#include "apps/study/manifest.h"
#include "io/file.h"

namespace corral {
namespace {

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

StudyOutcome finish_study(const WorkList& list, FinishedUnits& finished, const std::string& folder,
                          const std::string& command_line) {
  std::vector<std::size_t> all(list.units.size());
  std::iota(all.begin(), all.end(), 0);
  StudyOutcome outcome = outcome_of(list, finished, all);
  StudyFolder run{folder, {}, {}, assemble_records(list, finished.results())};
  for (const Experiment& experiment : list.experiments) run.experiments.push_back(experiment.info);
  const std::string manifest =
      manifest_text(list, finished.inputs(), {finished.results(), finished.machines(), command_line});
  finished.release_results();  // a large study needs the room
  outcome.summary = summarize(experiment_tables(run));
  outcome.losses = losses_of(run);
  const std::filesystem::path place(folder);
  write_files({{(place / "records.csv").string(), records_text(run.records)},
               {(place / "summary.csv").string(), summary_text(outcome.summary)},
               {(place / "manifest.json").string(), manifest}});
  remove_leftovers((place / "selections").string());  // of calls that were killed
  return outcome;
}

}  // namespace corral
