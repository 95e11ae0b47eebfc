// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/columns/otsu.h"
#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

struct GameTheoryOptions {
  int rounds = 100;
  OtsuRule otsu = OtsuRule::Exact;
  bool distinct = false;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"rounds", "", "", "rounds of the evolution", at_least(1)}, self.rounds);
    visit(OptionField{"otsu", "", "", "how the threshold on the share is found"}, self.otsu);
    visit(OptionField{"distinct", "", "", "matches that share a point gain nothing from each other"}, self.distinct);
  }
};

/// Game theory matching (GTM): matches play against each other, and those that gain most from the others prevail.
///
///   M_ij = min(l/l', l'/l),  M_ii = 0,   l = |p_i - p_j|, l' = |p'_i - p'_j|   (0 if one of them is 0)
///   x_i = 1/M;   `rounds` times  x_i <- x_i (M x)_i / x^T M x        selected = { i : x_i >= Otsu(x) }
///
/// Source    [rodola2013scale]; one of the nine of [yang2021performance].
/// Reads     source_points, target_points.
/// Returns   selected; scores: x, whose sum is 1.
/// Cost      O(rounds M^2) time, 4 M^2 bytes. Deterministic, and a function of the set of rows.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   A fixed number of rounds and Otsu's threshold, as in programs of the authors of [yang2021performance]; the
///           original stops at convergence and keeps what is above a share of the largest. No two rows with a payoff, or
///           fewer than 2 rows: nothing.
GroupingResult group_by_game_theory(const CorrespondenceSet& matches, const GameTheoryOptions& options = {});
double working_memory(int matches, const GameTheoryOptions& options);

}  // namespace corral
