// SPDX-License-Identifier: MIT
#include "apps/claims/claim_rule.h"

#include <cmath>

namespace corral {

std::vector<RuleOutcome> ClaimRule::levels(const Draws& draws) const {
  std::vector<RuleOutcome> outcomes;
  for (const auto& numbers : measure.numbers(draws)) outcomes.push_back(test_numbers(*part, numbers, measure.scale()));
  return outcomes;
}

RuleOutcome ClaimRule::outcome(const Draws& draws) const {
  return test_levels(part->take == Take::EachLevel ? part->where : Quantifier::Every, levels(draws));
}

Verdict ClaimRule::verdict(const Draws& draws) const {
  if (!measure.reason().empty()) return Verdict::Undecidable;
  const RuleOutcome result = outcome(draws);
  if (std::isnan(result.margin)) return Verdict::Undecidable;
  return result.holds ? Verdict::Holds : Verdict::Fails;
}

std::vector<ClaimRule> rules_of(const ClaimBook& book, const Claim& claim, const ClaimData& data,
                                const Averaging& averaging) {
  std::vector<ClaimRule> rules;
  for (const ClaimPart& part : claim.parts) rules.push_back({&part, ClaimMeasure(book, part, data, averaging)});
  return rules;
}

Verdict verdict_of(const std::vector<ClaimRule>& rules, const Draws& draws) {
  Verdict all = Verdict::Holds;
  for (const ClaimRule& rule : rules) {
    if (rule.part->is_note) continue;
    const Verdict verdict = rule.verdict(draws);
    if (verdict == Verdict::Fails) return verdict;
    if (verdict == Verdict::Undecidable) all = verdict;
  }
  return all;
}

}  // namespace corral
