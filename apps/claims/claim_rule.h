// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/claims/claim_study.h"
#include "apps/claims/claims.h"

namespace corral {

/// A rule and the numbers that it is about.
struct ClaimRule {
  const ClaimPart* part;
  ClaimMeasure measure;

  std::vector<RuleOutcome> levels(const Draws& draws) const;
  RuleOutcome outcome(const Draws& draws) const;
  Verdict verdict(const Draws& draws) const;
};

std::vector<ClaimRule> rules_of(const ClaimBook& book, const Claim& claim, const ClaimData& data,
                                const Averaging& averaging);

/// Fails if one rule fails, holds if all hold; notes decide nothing.
Verdict verdict_of(const std::vector<ClaimRule>& rules, const Draws& draws);

}  // namespace corral
