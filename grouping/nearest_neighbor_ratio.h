// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// How eq. (2) and its threshold are interpreted.
enum class RatioRule {
  Lowe,     ///< d1/d2 <= threshold, as in the work that the paper takes the value from
  Literal,  ///< 1 - d1/d2 >= threshold, as printed
};
constexpr std::array<const char*, 2> choice_names(RatioRule) { return {"lowe", "literal"}; }

struct NearestNeighborRatioOptions {
  double threshold = 0.8;
  RatioRule ratio = RatioRule::Lowe;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"threshold", "", "0.8", "bound of the ratio test", within(0, 1)}, self.threshold);
    visit(OptionField{"ratio", "", "literal", "d1/d2 <= threshold (lowe) or 1 - d1/d2 >= threshold (literal)"},
          self.ratio);
  }
};

/// Nearest-neighbour similarity ratio (NNSR): keeps the matches whose best feature is much better than the second best.
///
///   s(c) = 1 - d1/d2        selected = { c : d1/d2 <= threshold }
///
/// Source    [yang2017evaluation] eq. (2); [lowe2004distinctive].
/// Reads     feature_distance, second_feature_distance.
/// Returns   selected, scores.
/// Cost      O(M) time, O(M) memory. Deterministic.
/// Throws    InvalidInput: option out of range, column absent, ragged or non-finite.
/// Departs   The paper prints s >= 0.8, which hardly anything passes; its text keeps Lowe's value, d1/d2 <= 0.8. A match
///           without a second nearest feature, or with d2 = 0, is never kept and scores 0.
GroupingResult group_by_nearest_neighbor_ratio(const CorrespondenceSet& matches,
                                               const NearestNeighborRatioOptions& options = {});
double working_memory(int matches, const NearestNeighborRatioOptions& options);

}  // namespace corral
