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
  std::string run;    ///< folder of the run
  std::string cache;  ///< folder of intermediate results, which several runs may share; empty: within the run's
  int jobs = 1;       ///< pairs at a time; 0: as many as the machine has processors
  std::string command_line;
};

struct StudyProgress {
  std::size_t done = 0, failed = 0, total = 0;  ///< units of work
};

struct StudyOutcome {
  std::size_t units = 0, failed = 0;  ///< units; those where the pair, or a method on it, failed
  std::vector<SummaryRow> summary;
};

/// Does what is left of the work list, one file per unit below `units/` as soon as it is done, and writes the run's folder.
/// Killed at any moment, the next call goes on; what comes out does not depend on that, nor on the jobs (but times do).
/// Throws    IoError: the folder cannot be written, holds another run, or is being worked on by another call.
StudyOutcome run_study(const WorkList& list, const StudySettings& settings,
                       const std::function<void(const StudyProgress&)>& observer);

/// Keeps others from working in a folder as long as it lives; the system lets go of it when the program ends in any way.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);  ///< throws IoError if another keeps it for two seconds
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace corral
