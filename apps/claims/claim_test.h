// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/claims/claim_file.h"

namespace corral {

/// The distance of a rule from failing or, if negative, from holding, in the unit of its numbers.
struct RuleOutcome {
  bool holds = false;
  double margin = 0;  ///< NaN if a number is missing
};

/// What the numbers of a rule are.
struct Scale {
  double tau = 0;                ///< x beats y if it is better by more than this
  bool is_logarithm = false;     ///< of times: constants and factors are taken to logarithms too
  bool lower_is_better = false;  ///< for ranks
};

/// Whether numbers, one for each method (or a single one), pass the comparisons and sets of a rule. Margins closer to 0 than
/// 1e-12 are 0, so that "exactly tau" does not depend on rounding: it does not exceed tau.
RuleOutcome test_numbers(const ClaimPart& part, const std::vector<double>& numbers, const Scale& scale);

/// At how many of the levels a rule has to hold.
int needed_levels(Quantifier quantifier, int levels);
/// Over the levels: the margin is that of the level that decides.
RuleOutcome test_levels(Quantifier quantifier, std::vector<RuleOutcome> levels);

/// 1 + the number of others that beat each.
std::vector<int> ranks_of(const std::vector<double>& numbers, const Scale& scale);

/// Each number minus the largest other one.
std::vector<double> leads_of(const std::vector<double>& numbers);

}  // namespace corral
