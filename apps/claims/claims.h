// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/claims/claim_file.h"
#include "apps/results/study_results.h"

namespace corral {

enum class Verdict { Holds, Fails, Undecidable };
std::string verdict_name(Verdict verdict);

/// What a margin is in, and with how many decimals it is told.
struct MarginUnit {
  std::string name;
  int decimals = 3;
};

/// The result of one rule.
struct PartVerdict {
  std::string id;  ///< such as "C1a"; that of the claim if it has one rule
  Verdict verdict = Verdict::Undecidable;
  std::string reason;  ///< why it is undecidable; else empty
  double margin = 0;   ///< from the boundary, below 0 on the failing side; only if it was decided
  MarginUnit unit;
  std::string levels;  ///< for rules about each level: where it holds, such as "2 of 3 levels: 0.35 0.4"
  bool is_note = false;
};

/// The result of a claim. It holds if all its rules hold, fails if one fails.
struct ClaimVerdict {
  std::string id, text, note;
  Verdict verdict = Verdict::Undecidable;
  std::optional<double> margin;  ///< the least margin of its rules
  MarginUnit unit;
  double changed = 0;         ///< share of the resamples over pairs with another verdict
  bool is_weak = false;       ///< more than 20 %
  bool is_sensitive = false;  ///< (P + R) / 2 instead of F1 gives another verdict
  std::vector<PartVerdict> parts;
  std::vector<std::string> experiments;  ///< where to look
  std::vector<std::string> figures;      ///< the panel of each, empty if it has none
};

/// Judges every claim on what several studies hold together. Throws InvalidInput if two of them have the same experiment.
std::vector<ClaimVerdict> judge_claims(const ClaimBook& book, const std::vector<StudyResults>& studies,
                                       const ParallelFor& parallel_for = one_by_one);

}  // namespace corral
