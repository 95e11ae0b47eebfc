// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/claims/claims.h"
#include "apps/runtime/json.h"

namespace corral {

/// The verdicts under a heading for each experiment, with margins, parts and references, and the paper's slips below.
std::string claims_text(const std::vector<ClaimVerdict>& verdicts, const std::vector<std::string>& slips);

/// The same as a list, one object per claim.
Json claims_json(const std::vector<ClaimVerdict>& verdicts);

}  // namespace corral
