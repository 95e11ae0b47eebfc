// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/columns/otsu.h"
#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

struct SimilarityScoreOptions {
  OtsuRule otsu = OtsuRule::Exact;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"otsu", "", "", "how the threshold is found"}, self.otsu);
  }
};

/// Similarity score (SS): keeps the matches whose features are similar, by a threshold found with Otsu's method.
///
///   s(c) = 1 - d1        selected = { c : s(c) >= Otsu(s) }
///
/// Source    [yang2017evaluation]; threshold [otsu1979threshold].
/// Reads     feature_distance.
/// Returns   selected, scores.
/// Cost      O(M log M) time, O(M) memory. Deterministic.
/// Throws    InvalidInput: column absent, ragged or non-finite.
/// Departs   Otsu is exact over the scores, not over a histogram (the paper gives no bins); all scores equal: all kept.
GroupingResult group_by_similarity_score(const CorrespondenceSet& matches, const SimilarityScoreOptions& options = {});
double working_memory(int matches, const SimilarityScoreOptions& options);

}  // namespace corral
