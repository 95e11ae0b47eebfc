// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/pair/match_pair.h"
#include "apps/runtime/json.h"

namespace corral {

/// `lengths`: the options in pr of the detector and the descriptor, in mesh units.
Json to_json(const MatchReport& report);

/// The stage report in words, for stderr.
std::string stage_report(const MatchReport& report);

}  // namespace corral
