// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/pair/match_pair.h"
#include "apps/runtime/json.h"

namespace corral {

/// `lengths`: the options in pr of the detector and the descriptor, in mesh units.
Json to_json(const MatchReport& report);

/// All warnings, that of the units last.
std::vector<std::string> warnings_of(const MatchReport& report);

/// Warnings and hints, a line each, for stderr.
std::vector<std::string> advice(const MatchReport& report);

/// The stage report in words with the same lines, for stderr.
std::string stage_report(const MatchReport& report);

}  // namespace corral
