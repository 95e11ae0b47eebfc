// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/consistency_voting.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// For tables without equal feature ratios.
Selection consistency_voting(const CorrespondenceSet& matches, const ConsistencyVotingOptions& options);

}  // namespace corral::reference
