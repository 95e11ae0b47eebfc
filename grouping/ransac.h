// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

struct RansacOptions {
  int iterations = 10000;
  double tolerance_pr = 5;
  std::uint64_t seed = 1;
  double confidence = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"iterations", "", "10000", "random triples tried", at_least(1)}, self.iterations);
    visit(OptionField{"tolerance_pr", "pr", "5", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"seed", "", "", "start of the random stream", at_least(0)}, self.seed);
    visit(OptionField{"confidence", "", "0", "stop once a triple of correct matches is this probable; 0: never",
                      within(0, 1)},
          self.confidence);
  }
};

/// Random sample consensus (RANSAC): the matches that agree with the best pose of many random triples.
///
///   e(c, T) = |T p - p'|        T* = argmax_T | { c : e(c, T) < tolerance } |        selected = { c : e(c, T*) < tolerance }
///
/// confidence  stops before iteration k if (1 - w^3)^k <= 1 - confidence, w the share of matches in agreement with T*.
/// Source    [fischler1981random]; form and values [yang2017evaluation], Table 1.
/// Reads     source_points, target_points, resolution.
/// Returns   selected, and the pose T* of the winning triple (not refitted).
/// Cost      O(iterations * M) time, O(M) memory. Deterministic for a seed. A triple that cannot win any more is dropped
///           before all of its residuals are known (see filter.h); the winner is that of the plain loop.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   A triple whose area is at most 1e-3 pr^2 on either side gives no pose but counts as an iteration (the paper does
///           not say). The first triple with the largest count wins. Fewer than 3 matches, or no triple with a match in
///           agreement: nothing selected, no pose.
GroupingResult group_by_ransac(const CorrespondenceSet& matches, const RansacOptions& options = {});
double working_memory(int matches, const RansacOptions& options);

}  // namespace corral
