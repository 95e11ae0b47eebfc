// SPDX-License-Identifier: MIT
#include "apps/claims/claim_outcomes.h"

#include <algorithm>
#include <limits>

namespace corral {

ClaimOutcomes::ClaimOutcomes(const ClaimBook& book, const ClaimStudy& study, const Averaging& averaging)
    : study_(study) {
  for (const Claim& claim : book.claims) rules_.push_back(rules_of(book, claim, study.data, averaging));
}

std::vector<ClaimOutcome> ClaimOutcomes::outcomes() const {
  const Draws draws = study_.all_rows();
  std::vector<ClaimOutcome> outcomes;
  for (const std::vector<ClaimRule>& rules : rules_) {
    ClaimOutcome outcome{verdict_of(rules, draws), std::numeric_limits<double>::infinity()};
    for (const ClaimRule& rule : rules)
      if (!rule.part->is_note && rule.measure.reason().empty())
        outcome.margin = std::min(outcome.margin, rule.outcome(draws).margin);
    if (outcome.verdict == Verdict::Undecidable) outcome.margin = 0;
    outcomes.push_back(outcome);
  }
  return outcomes;
}

std::vector<Verdict> ClaimOutcomes::resampled(int repeat) const {
  const Draws draws = study_.resampled(repeat);
  std::vector<Verdict> verdicts;
  for (const std::vector<ClaimRule>& rules : rules_) verdicts.push_back(verdict_of(rules, draws));
  return verdicts;
}

}  // namespace corral
