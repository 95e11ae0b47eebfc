// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/commands/pair/pair_run.h"

namespace corral {

/// What `corral run` prints: JSON, or tables and below them what they mean.
Json to_json(const PairRun& run, const RunSettings& settings);
std::string in_words(const PairRun& run, const RunSettings& settings);

/// All that a run writes to its folder, or removes as that of an earlier call.
std::vector<std::string> files_of_run(const std::string& folder, const std::vector<ExternalMethod>& externals);

/// Every intermediate file of the run, all or none; files that an earlier call left of other groupers are removed.
void write_folder(const PairRun& run, const RunSettings& settings);

}  // namespace corral
