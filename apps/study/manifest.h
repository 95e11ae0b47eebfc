// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/study/evaluate_unit.h"
#include "apps/study/work_list.h"

namespace corral {

/// The hash of every file that the units name; those that cannot be read have none.
InputHashes hash_inputs(const WorkList& list);

/// The content of manifest.json: the program, the machine, the command line, the experiments in full, the pairs and the hash
/// of every input. `results`: one for each unit, or none before they exist.
std::string manifest_text(const WorkList& list, const InputHashes& inputs, const std::vector<UnitResult>& results,
                          const std::string& command_line);

/// Throws IoError if the folder holds a study of other experiments or other data, or of another version of the program.
void check_same_run(const std::string& folder, const WorkList& list, const InputHashes& inputs);

}  // namespace corral
