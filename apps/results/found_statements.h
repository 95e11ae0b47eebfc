// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/set_table.h"

namespace corral {

/// A sentence about the pairs of a data set, and the number that it rests on.
struct FoundStatement {
  std::string text;
  std::string dataset;
  int pairs = 0;             ///< that the number is over
  double margin = 0;         ///< mean difference on the same pairs (of shares, so without a unit)
  double low = 0, high = 0;  ///< its bootstrap interval of 95 %

  bool is_clear() const { return low > 0; }  ///< the interval is above 0
};

/// What studies show beside the paper's findings, by rules that were fixed before any result, as the claims' were. For each data
/// set, as far as it has what they need:
///
///   refinement     GC (else the method that gains most) registers more pairs after the refinement than before
///   perfect        all correct matches register more pairs than the best grouper
///   precise        the grouper that registers most pairs registers more than the most precise one, if these are two
///   recall         and more than the one with the best recall
///   hardest        the least share of correct matches (kCorrectShares, bins of at least 5 pairs) at which a grouper registers
///                  half of the pairs, and which one registers most there: its lead over the next
///
/// The margin is the mean over the pairs of the difference of success (bootstrap.h). Statements of one rule stand together; at most
/// `most`. A margin of exactly 0 is left out, as it says nothing.
std::vector<FoundStatement> found_statements(const std::vector<SetTable>& tables, std::size_t most = 10);

}  // namespace corral
