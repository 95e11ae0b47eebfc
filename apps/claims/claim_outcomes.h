// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/claims/claim_rule.h"

namespace corral {

/// A claim judged without words.
struct ClaimOutcome {
  Verdict verdict = Verdict::Undecidable;
  double margin = 0;  ///< the least of its rules; 0 where it is undecidable
};

/// Every claim of a book on the same tables, for callers that judge many tables. Book and study must outlive it.
class ClaimOutcomes {
 public:
  ClaimOutcomes(const ClaimBook& book, const ClaimStudy& study, const Averaging& averaging);

  std::vector<ClaimOutcome> outcomes() const;        ///< of all pairs, one for each claim
  std::vector<Verdict> resampled(int repeat) const;  ///< the verdicts on pairs drawn anew, as judge_claims draws them

 private:
  const ClaimStudy& study_;
  std::vector<std::vector<ClaimRule>> rules_;
};

}  // namespace corral
