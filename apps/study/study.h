// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "apps/results/losses.h"
#include "apps/results/summary.h"
#include "apps/study/evaluate_unit.h"
#include "apps/study/shard.h"
#include "apps/study/study_call.h"

namespace corral {

struct StudySettings {
  std::string run;    ///< folder of the study
  std::string cache;  ///< folder of intermediate results, which several studies may share; empty: within the study's
  std::uint64_t cache_limit = 0;  ///< bytes of that folder; 0: none
  int jobs = 1;                   ///< pairs at a time; 0: as many as the machine has processors
  Shard shard;                    ///< the part of the study to do
  std::string command_line;
};

struct StudyProgress {
  std::size_t done = 0, failed = 0, total = 0;  ///< units of work, of the shard
  double expected_s = 0;  ///< that those left when the call began take together on one processor, by the plan
};

/// How run_study tells of its work. Both are called by one thread at a time.
struct StudyObserver {
  std::function<void(const StudyProgress&)> progress;
  std::function<void(const StudyProgress&)> stopped;  ///< SIGINT or SIGTERM came: the program ends behind it
};

struct StudyOutcome {
  std::size_t units = 0, failed = 0;  ///< units; those where the pair, or a grouper on it, failed
  std::vector<std::string> misfits;   ///< the pairs whose truth does not fit, each with what is wrong
  std::vector<std::string> warnings;  ///< of other data that make results wrong, with the pair
  std::vector<SummaryRow> summary;    ///< of a whole study
  std::vector<LossRow> losses;        ///< likewise
};

/// Evaluates the remaining units of a study, or of a shard of it, and keeps each in a journal as soon as it is done. After
/// being stopped at any moment, the next call continues; the results do not depend on that, nor on the number of jobs or shards
/// (times do). A whole study uses what shards have done in its folder, and ends with its tables: records.csv, summary.csv,
/// manifest.json.
/// Throws    IoError: the folder cannot be written, holds another study, or is in use by another call.
StudyOutcome run_study(const WorkList& list, const StudyCall& call, const StudySettings& settings,
                       const StudyObserver& observer);

/// The results of all units of a study, evaluated, kept and continued as run_study does, but without its tables.
std::vector<UnitResult> run_units(const WorkList& list, const StudyCall& call, const StudySettings& settings,
                                  const StudyObserver& observer);

struct MergeOutcome {
  StudyOutcome study;
  std::vector<std::string>
      notes;  ///< what the user should know: units that two shards both did, processors that differ
};

/// Makes the tables of a study from its shards, without evaluating anything. It may be repeated. `parts`: folders of shards that
/// are elsewhere, whose files are copied first. `data`: where the data sets are, if that is not where the shards found them.
/// Throws    IoError: naming the shards that are missing, unfinished, damaged, of another study or of another version.
MergeOutcome merge_study(const std::string& folder, const std::vector<std::string>& parts, const std::string& data);

/// Keeps other calls for the same shard out of a folder as long as it lives; the system releases the lock however the program
/// ends. On a network file system it holds as far as that passes flock on to its server (NFS 4 does; NFS 3 with its lock
/// service). Where there are no locks at all, two calls do the same work twice and nothing is lost: each writes a journal of
/// its own, and both come to the same results.
class FolderLock {
 public:
  /// Throws IoError if another process holds it for two seconds.
  explicit FolderLock(const std::string& folder, const Shard& shard = {});
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace corral
