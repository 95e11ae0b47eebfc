// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "apps/results/summary.h"
#include "apps/study/work_list.h"

namespace corral {

struct StudySettings {
  std::string run;    ///< folder of the study
  std::string cache;  ///< folder of intermediate results, which several studies may share; empty: within the study's
  int jobs = 1;       ///< pairs at a time; 0: as many as the machine has processors
  std::string command_line;
};

struct StudyProgress {
  std::size_t done = 0, failed = 0, total = 0;  ///< units of work
};

struct StudyOutcome {
  std::size_t units = 0, failed = 0;  ///< units; those where the pair, or a grouper on it, failed
  std::vector<std::string> misfits;   ///< the pairs whose truth does not fit, each with what is wrong
  std::vector<std::string> warnings;  ///< of other data that make results wrong, with the pair
  std::vector<SummaryRow> summary;
};

/// Evaluates the remaining units of the work list, one file per unit in `units/` as soon as it is done, and writes the study
/// folder. After being killed at any moment, the next call continues; the results do not depend on that, nor on the number of
/// jobs (times do).
/// Throws    IoError: the folder cannot be written, holds another study, or is in use by another call.
StudyOutcome run_study(const WorkList& list, const StudySettings& settings,
                       const std::function<void(const StudyProgress&)>& observer);

/// Locks a folder as long as it lives; the system releases the lock however the program ends.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);  ///< throws IoError if another process holds it for two seconds
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace corral
