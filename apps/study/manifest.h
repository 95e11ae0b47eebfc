// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "apps/study/journal.h"

namespace corral {

/// The hash of every file that these units name; those that cannot be read have an empty one. `jobs`: files at a time.
InputHashes hash_inputs(const WorkList& list, const std::vector<std::size_t>& units, int jobs);

/// Of the answers of other programs that can be read here.
InputHashes hash_answers(const WorkList& list);

/// What this program and this work list are known by.
StudyIdentity identity_of(const WorkList& list);
Json machine_json();

/// How a study was made.
struct StudyOrigin {
  const std::vector<UnitResult>& results;  ///< one for each unit
  const std::set<std::string>& machines;   ///< as FinishedUnits has them
  const std::string& command_line;
};

/// The content of manifest.json: the program, the machines, the command line, the experiments in full, the pairs and the hash
/// of every input.
std::string manifest_text(const WorkList& list, const InputHashes& inputs, const StudyOrigin& origin);

/// Throws IoError if the folder holds a finished study of other experiments, or of another version of the program.
void check_same_study(const std::string& folder, const StudyIdentity& mine);

}  // namespace corral
