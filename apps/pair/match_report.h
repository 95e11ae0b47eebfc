// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/pair/match_pair.h"
#include "apps/runtime/json.h"

namespace corral {

Json to_json(const MatchReport& report);
Json to_json(const MatchSettings& settings);  ///< what results depend on

/// The stage report in words, for stderr.
std::string stage_report(const MatchReport& report);

}  // namespace corral
