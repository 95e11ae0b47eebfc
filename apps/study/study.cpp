// SPDX-License-Identifier: MIT
#include "apps/study/study.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include "apps/runtime/build_info.h"
#include "apps/runtime/stop_signals.h"
#include "apps/runtime/stopwatch.h"
#include "apps/runtime/workers.h"
#include "apps/study/finish_study.h"
#include "apps/study/finished_units.h"
#include "apps/study/manifest.h"
#include "apps/study/plan.h"
#include "io/disk/file.h"
#include "io/disk/open_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// The units of a shard, ascending.
std::vector<std::size_t> units_of(const WorkList& list, const Shard& shard) {
  const std::vector<int> shard_of = split_units(estimate_units(list), shard.count);
  std::vector<std::size_t> units;
  for (std::size_t unit = 0; unit < shard_of.size(); ++unit)
    if (shard_of[unit] == shard.number) units.push_back(unit);
  return units;
}

/// Evaluates units of a study and keeps them in its journal.
class Runner {
 public:
  Runner(const WorkList& list, const StudySettings& settings, JournalWriter journal, FinishedUnits& finished)
      : list_(list),
        folder_(settings.run),
        shard_(settings.shard),
        store_(settings.cache.empty() ? (folder_ / "cache").string() : settings.cache, settings.cache_limit),
        inputs_(finished.inputs()),
        journal_(std::move(journal)),
        finished_(finished) {
    finished_.add_machine(machine_json());
  }

  void run(const std::vector<std::size_t>& units, int jobs, const StudyObserver& observer) {
    std::vector<std::size_t> left;
    progress_.total = units.size();
    for (const std::size_t unit : units)
      if (finished_.has(unit))
        note(unit);
      else
        left.push_back(unit);
    const std::vector<UnitEstimate> estimates = estimate_units(list_);
    for (const std::size_t unit : left) progress_.expected_s += estimates[unit].seconds();
    observer.progress(progress_);
    workers(jobs)(static_cast<int>(left.size()), [&](int i) {
      const std::size_t unit = left[static_cast<std::size_t>(i)];
      evaluate(unit);
      const std::lock_guard<std::mutex> guard(mutex_);
      note(unit);
      observer.progress(progress_);
    });
  }

  /// Lets no thread write any more, and returns between two units' files.
  StudyProgress stop() {
    writing_.lock();
    mutex_.lock();
    return progress_;
  }

 private:
  /// The line in the journal is written last: where it is, the other files are.
  void evaluate(std::size_t number) {
    const WorkUnit& unit = list_.units[number];
    Stopwatch watch;
    std::vector<FileContent> files;
    JournalEntry entry;
    entry.result = evaluate_unit({unit, inputs_, store_}, files);
    entry.unit = unit_key(unit);
    const std::vector<std::string> names = unit.files();
    const std::size_t of_pair = unit.pair.files().size();
    for (std::size_t i = 0; i < names.size(); ++i)  // without those of the pair it is done again when they can be read
      entry.inputs.push_back(entry.result.is_unreadable && i < of_pair ? "" : hash_of(inputs_, names[i]));
    entry.seconds = watch.lap_ms() / 1000;
    for (FileContent& file : files) {
      file.path = (folder_ / file.path).string();
      make_folder(fs::path(file.path).parent_path().string());
    }
    const std::shared_lock<std::shared_mutex> writing(writing_);
    write_files(files);
    const std::lock_guard<std::mutex> guard(mutex_);
    journal_.append(entry);
    finished_.add(number, std::move(entry), {"", shard_, 0});
  }

  void note(std::size_t unit) {
    ++progress_.done;
    progress_.failed += has_failed(finished_.results()[unit]);
  }

  const WorkList& list_;
  const fs::path folder_;
  const Shard shard_;
  const ContentStore store_;
  const InputHashes inputs_;  ///< as they were when the call began
  JournalWriter journal_;
  FinishedUnits& finished_;
  std::shared_mutex writing_;  ///< shared by those who write files of units
  std::mutex mutex_;           ///< of the journal, the results and the progress
  StudyProgress progress_;
};

}  // namespace

FolderLock::FolderLock(const std::string& folder, const Shard& shard) {
  const std::string path = folder + (shard.is_whole() ? "/lock" : "/lock-" + file_name(shard));
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail_by_errno(path, "be created");
  // A call that was killed a moment ago may not have ended yet.
  for (int attempt = 0; attempt < 40; ++attempt, std::this_thread::sleep_for(std::chrono::milliseconds(50)))
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // or there are no locks here
  ::close(descriptor_);
  throw IoError(folder, "",
                shard.is_whole()
                    ? "another call is working on this study, expected only one at a time"
                    : "another call is working on shard " + to_text(shard) + ", expected only one at a time");
}

FolderLock::~FolderLock() { ::close(descriptor_); }

namespace {

/// Evaluates what is left, and hands over all that is finished before the folder is released.
void run_study(const WorkList& list, const StudyCall& call, const StudySettings& settings,
               const StudyObserver& observer,
               const std::function<void(FinishedUnits&, const std::vector<std::size_t>& units)>& finish) {
  std::atomic<Runner*> running = nullptr;
  const StopSignals signals([&] { observer.stopped(running ? running.load()->stop() : StudyProgress()); });
  make_folder(settings.run);
  const FolderLock lock(settings.run, settings.shard);
  const StudyIdentity mine = identity_of(list);
  check_same_study(settings.run, mine);
  const std::vector<std::size_t> units = units_of(list, settings.shard);
  FinishedUnits finished(list, settings.run, hash_inputs(list, units, settings.jobs));
  // A shard needs its own journals alone, the whole study those of all shards.
  for (const JournalFile& journal :
       find_journals(settings.run, settings.shard.is_whole() ? std::nullopt : std::optional<Shard>(settings.shard))) {
    JournalReader reader(journal.path);
    if (!reader.header()) continue;  // ended before its first line was whole
    const std::string difference = reader.header()->identity.difference_from(mine);
    if (!difference.empty())
      throw IoError(journal.path, "",
                    "was made " + difference + ", expected another folder for -o (or remove this one)");
    finished.add(reader, journal);
  }
  finished.drop_unreadable();
  Runner runner(list, settings, {settings.run, {mine, settings.shard, call, settings.command_line, machine_json()}},
                finished);
  running = &runner;
  runner.run(units, settings.jobs, observer);
  finish(finished, units);
}

}  // namespace

StudyOutcome run_study(const WorkList& list, const StudyCall& call, const StudySettings& settings,
                       const StudyObserver& observer) {
  StudyOutcome outcome;
  run_study(list, call, settings, observer, [&](FinishedUnits& finished, const std::vector<std::size_t>& units) {
    outcome = settings.shard.is_whole() ? finish_study(list, finished, settings.run, settings.command_line)
                                        : outcome_of(list, finished, units);
  });
  return outcome;
}

std::vector<UnitResult> run_units(const WorkList& list, const StudyCall& call, const StudySettings& settings,
                                  const StudyObserver& observer) {
  std::vector<UnitResult> results;
  run_study(list, call, settings, observer,
            [&](FinishedUnits& finished, const std::vector<std::size_t>&) { results = finished.results(); });
  return results;
}

}  // namespace corral
