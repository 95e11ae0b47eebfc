// SPDX-License-Identifier: MIT
#include "grouping/game_theory.h"

#include "grouping/columns/canonical_order.h"
#include "grouping/graph/pair_matrix.h"

namespace corral {
namespace {

/// One round; false without any gain.
bool evolve(const PairMatrix& payoffs, AlignedColumn& shares, AlignedColumn& gains) {
  payoffs.multiply(shares, gains);
  double mean = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) mean += shares[i] * gains[i];
  if (!(mean > 0)) return false;
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] *= gains[i] / mean;
  return true;
}

GroupingResult group_in_order(const CorrespondenceSet& matches, const GameTheoryOptions& options) {
  const auto rows = static_cast<std::size_t>(matches.size());
  const PairMatrix payoffs = PairMatrix::of_ratios(matches, options.distinct);
  AlignedColumn shares(static_cast<std::size_t>(padded(matches.size())), 0), gains(shares);
  std::fill_n(shares.begin(), rows, 1.0 / matches.size());
  for (int round = 0; round < options.rounds; ++round)
    if (!evolve(payoffs, shares, gains)) return {};
  GroupingResult result;
  result.scores.assign(shares.begin(), shares.begin() + matches.size());
  result.selected = select_by_otsu(result.scores, options.otsu);
  return result;
}

}  // namespace

GroupingResult group_by_game_theory(const CorrespondenceSet& matches, const GameTheoryOptions& options) {
  validate_options(options, "gtm");
  matches.validate();
  if (matches.size() < 2) return {};
  return group_in_canonical_order(matches,
                                  [&](const CorrespondenceSet& sorted) { return group_in_order(sorted, options); });
}

double working_memory(int matches, const GameTheoryOptions& options) {
  return canonical_order_memory(matches) + PairMatrix::memory(matches) + 24.0 * padded(matches) +
         otsu_memory(matches, options.otsu);
}

}  // namespace corral
