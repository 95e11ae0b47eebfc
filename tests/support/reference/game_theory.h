// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/game_theory.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

Selection game_theory(const CorrespondenceSet& matches, const GameTheoryOptions& options);

/// x^T M x.
double mean_payoff(const CorrespondenceSet& matches, const std::vector<double>& shares);

}  // namespace corral::reference
