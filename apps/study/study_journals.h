// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "apps/study/journal.h"

namespace corral {

/// The journals in the folder of a study, and what their headers say.
struct StudyJournals {
  StudyIdentity identity;
  StudyCall call;
  std::string command_line;  ///< of the first of them
  std::vector<JournalFile> files;
};

/// Journals whose first line is not whole are left out: nothing is in them. Throws IoError if there are none, or if one belongs
/// to another study than most.
StudyJournals find_study(const std::string& folder);

/// The work list of a study from its journals; `data`: where the data sets are, if not where they were. Throws IoError if it
/// has become another one, or is that of another version of the program.
WorkList work_list_of(const StudyJournals& study, const std::string& data = "");

/// The times that the units of a study took, by unit_key.
struct RecordedTimes {
  std::unordered_map<std::string, double> seconds;
  double factor = 1;  ///< how much longer these units took than they are estimated to (plan.h)
};
RecordedTimes recorded_times(const std::string& folder);

}  // namespace corral
