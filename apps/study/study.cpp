// SPDX-License-Identifier: MIT
#include "apps/study/study.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

#include "apps/pair/truth_fit.h"
#include "apps/runtime/workers.h"
#include "apps/study/assemble.h"
#include "apps/study/manifest.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// Removes files that a killed call left unfinished: the names of finished ones end in .csv or .json, or have no ending.
void remove_unfinished(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> unfinished;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    const std::string ending = entry.path().extension().string();
    if (entry.is_regular_file(ignored) && !ending.empty() && ending != ".csv" && ending != ".json")
      unfinished.push_back(entry.path());
  }
  for (const fs::path& file : unfinished) remove_file(file.string());
}

bool has_failed(const UnitResult& result) {
  return !result.failure.empty() ||
         std::any_of(result.tasks.begin(), result.tasks.end(), [](const TaskResult& task) { return !task.selected; });
}

/// Whether a result has everything that the unit requires.
bool fits(const UnitResult& result, const WorkUnit& unit) {
  if (!result.failure.empty()) return true;
  const std::size_t thresholds = result.has_truth ? unit.thresholds_pr.size() : 0;
  const auto is_whole = [&](const TaskResult& task) {
    if (task.correct.size() != (task.selected ? thresholds : 0)) return false;
    for (std::size_t i = 0; i < task.correct.size(); ++i)
      if (task.correct[i] > std::min(*task.selected, result.true_matches[i])) return false;
    return true;
  };
  return result.tasks.size() == unit.tasks.size() && result.true_matches.size() == thresholds &&
         result.frame_share.size() == thresholds && result.oracles.size() == thresholds &&
         result.baseline.has_value() == result.has_truth &&
         std::all_of(result.tasks.begin(), result.tasks.end(), is_whole) &&
         std::all_of(result.oracles.begin(), result.oracles.end(), is_whole) &&
         (!result.baseline || is_whole(*result.baseline));
}

/// What is wrong with the data of the pairs, each pair once, in the order of the units.
void add_warnings(const WorkList& list, const std::vector<UnitResult>& results, StudyOutcome& outcome) {
  std::set<std::string> named;
  for (std::size_t unit = 0; unit < results.size(); ++unit) {
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

/// Evaluates the units of a study and writes their files.
class Runner {
 public:
  Runner(const WorkList& list, const InputHashes& inputs, const StudySettings& settings,
         const std::function<void(const StudyProgress&)>& observer)
      : list_(list),
        inputs_(inputs),
        folder_(settings.run),
        store_(settings.cache.empty() ? (folder_ / "cache").string() : settings.cache),
        observer_(observer),
        results_(list.units.size()) {
    progress_.total = list.units.size();
    for (const WorkUnit& unit : list.units)
      for (const auto& [file, shown] : unit.selections) make_folder((folder_ / file).parent_path().string());
    make_folder((folder_ / "units").string());
  }

  std::vector<UnitResult> run(int jobs) {
    std::vector<int> left;
    for (std::size_t i = 0; i < list_.units.size(); ++i) {
      auto found = stored(file_of(list_.units[i]), list_.units[i]);
      if (!found)
        left.push_back(static_cast<int>(i));
      else
        note(i, std::move(*found));
    }
    observer_(progress_);
    workers(jobs)(static_cast<int>(left.size()), [&](int i) {
      const auto unit = static_cast<std::size_t>(left[static_cast<std::size_t>(i)]);
      UnitResult result = evaluate(list_.units[unit]);
      const std::lock_guard<std::mutex> guard(mutex_);
      note(unit, std::move(result));
      observer_(progress_);
    });
    return std::move(results_);
  }

 private:
  std::string file_of(const WorkUnit& unit) const {
    return (folder_ / "units" / (unit_key(unit, inputs_) + ".json")).string();
  }

  /// A stored result that is complete and fits the unit.
  static std::optional<UnitResult> stored(const std::string& file, const WorkUnit& unit) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    std::optional<UnitResult> result = parse_unit_result(read_file(file));
    return result && fits(*result, unit) ? result : std::nullopt;
  }

  /// The unit's own file is written last: where it exists, the others do.
  UnitResult evaluate(const WorkUnit& unit) const {
    std::vector<FileContent> files;
    UnitResult result = evaluate_unit({unit, inputs_, store_}, files);
    for (FileContent& file : files) file.path = (folder_ / file.path).string();
    files.push_back({file_of(unit), unit_result_text(result)});
    write_files(files);
    return result;
  }

  void note(std::size_t unit, UnitResult result) {
    ++progress_.done;
    progress_.failed += has_failed(result);
    results_[unit] = std::move(result);
  }

  const WorkList& list_;
  const InputHashes& inputs_;
  const fs::path folder_;
  const ContentStore store_;
  const std::function<void(const StudyProgress&)>& observer_;
  std::mutex mutex_;
  StudyProgress progress_;
  std::vector<UnitResult> results_;
};

}  // namespace

FolderLock::FolderLock(const std::string& folder) {
  const std::string path = folder + "/lock";
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw IoError(path, "", "cannot be created");
  // A call that was killed a moment ago may not have ended yet.
  for (int attempt = 0; attempt < 40; ++attempt, std::this_thread::sleep_for(std::chrono::milliseconds(50)))
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw IoError(folder, "", "another call is working on this study, expected only one at a time");
}

FolderLock::~FolderLock() { ::close(descriptor_); }

StudyOutcome run_study(const WorkList& list, const StudySettings& settings,
                       const std::function<void(const StudyProgress&)>& observer) {
  const InputHashes inputs = hash_inputs(list);
  make_folder(settings.run);
  const FolderLock lock(settings.run);
  check_same_run(settings.run, list, inputs);
  const fs::path folder(settings.run);
  for (const char* part : {"units", "selections", "cache"}) remove_unfinished(folder / part);
  const std::string manifest = (folder / "manifest.json").string();
  std::error_code ignored;
  if (!fs::exists(manifest, ignored)) write_file(manifest, manifest_text(list, inputs, {}, settings.command_line));
  const std::vector<UnitResult> results = Runner(list, inputs, settings, observer).run(settings.jobs);
  StudyFolder run{settings.run, {}, {}, assemble_records(list, results)};
  for (const Experiment& experiment : list.experiments) run.experiments.push_back(experiment.info);
  StudyOutcome outcome;
  outcome.units = results.size();
  outcome.failed = static_cast<std::size_t>(std::count_if(results.begin(), results.end(), has_failed));
  outcome.summary = summarize(experiment_tables(run));
  add_warnings(list, results, outcome);
  write_files({{(folder / "records.csv").string(), records_text(run.records)},
               {(folder / "summary.csv").string(), summary_text(outcome.summary)},
               {manifest, manifest_text(list, inputs, results, settings.command_line)}});
  return outcome;
}

}  // namespace corral
