// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/columns/otsu.h"
#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// What a pair of matches is worth if one of them has no valid frame.
enum class FrameNeed {
  Required,  ///< nothing
  Optional,  ///< its rigidity alone
};
constexpr std::array<const char*, 2> choice_names(FrameNeed) { return {"required", "optional"}; }

struct ConsistencyVotingOptions {
  int voters = 20;
  double scale_pr = 10;
  double scale_deg = 10;
  FrameNeed frames = FrameNeed::Required;
  OtsuRule otsu = OtsuRule::Exact;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"voters", "", "", "matches with the best feature ratio, which vote on all", at_least(1)},
          self.voters);
    visit(OptionField{"scale_pr", "pr", "", "difference of lengths that counts 1/e", above(0)}, self.scale_pr);
    visit(OptionField{"scale_deg", "deg", "", "angle between frames that counts 1/e", above(0)}, self.scale_deg);
    visit(OptionField{"frames", "", "", "whether matches without a frame count for nothing or by their lengths"},
          self.frames);
    visit(OptionField{"otsu", "", "", "how the threshold on the score is found"}, self.otsu);
  }
};

/// Consistency voting (CV): the matches that agree in lengths and in frames with a few of the most distinctive ones.
///
///   V = the `voters` rows of the largest 1 - d1/d2
///   g(i,j) = exp(-(D_ij / scale_pr)^2 - (phi_ij / scale_deg)^2)
///   D_ij = | |p_i - p_j| - |p'_i - p'_j| |,   phi_ij = angle of (L'_i L'_j^T)(L_i L_j^T)^T
///   s_i = mean of g(i,j) over j in V, j != i        selected = { i : s_i >= Otsu(s) }
///
/// Source    one of the nine of [yang2021performance].
/// Reads     points, both feature distances, resolution; both frames (optional: where they are there).
/// Returns   selected, scores.
/// Cost      O(M voters) time, O(M) memory. Deterministic, and a function of the set of rows.
/// Throws    InvalidInput: option out of range, column absent, ragged or non-finite.
/// Departs   No program of its authors is public: the exponents and the scale of angles are a choice of ours, and results are no
///           reproduction of theirs. Of equal ratios the earlier row in canonical order votes. No other voter: s = 0.
GroupingResult group_by_consistency_voting(const CorrespondenceSet& matches,
                                           const ConsistencyVotingOptions& options = {});
double working_memory(int matches, const ConsistencyVotingOptions& options);

}  // namespace corral
