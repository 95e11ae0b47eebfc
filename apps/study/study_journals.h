// SPDX-License-Identifier: MIT
#pragma once

#include <string>
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

/// How much longer the recorded units of a study took than they are estimated to (plan.h): a factor for such a machine.
double recorded_over_estimated(const std::string& folder);

}  // namespace corral
