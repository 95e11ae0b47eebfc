// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "apps/claims/claim_outcomes.h"
#include "apps/reproduce/reading_tables.h"
#include "kernel/parallel.h"

namespace corral {

/// A combination on some pairs. The better of two holds more statements; of equal ones it has the larger sum of margins, each
/// cut to -0.1 .. 0.1; of equal ones the fewer departures from the text.
struct CombinationScore {
  Combination combination;
  std::vector<ClaimOutcome> outcomes;  ///< one for each claim of the book
  int holds = 0;
  double margin = 0;

  bool is_better_than(const CombinationScore& other) const;
};

/// A combination that the search took, and how sure that is.
struct SearchStep {
  CombinationScore score;
  double share_worse = 0;  ///< of the resamples in which it holds fewer statements than the one before
};

constexpr int kStepResamples = 200;
constexpr double kMostWorse = 0.2;

/// Where the tables of a combination come from, on all pairs or on a half.
using TableSource = std::function<JudgedTables(const Combination&, Half)>;

/// Judges combinations, each once. Points and book must outlive it.
class CombinationJudge {
 public:
  /// Several threads call `tables` for combinations with the same matches, after one of them was asked for alone.
  CombinationJudge(const std::vector<OpenPoint>& points, const ClaimBook& book, TableSource tables,
                   ParallelFor parallel)
      : points_(points), book_(book), tables_(std::move(tables)), parallel_(std::move(parallel)) {}

  const std::vector<OpenPoint>& points() const { return points_; }
  const CombinationScore& score(const Combination& combination, Half half);
  /// Judges those that were not judged before. Their matches are the same, or were all made before.
  void score_all(const std::vector<Combination>& combinations, Half half);
  /// How many statements hold in each of kStepResamples resamples over the pairs.
  const std::vector<int>& resampled(const Combination& combination, Half half);
  /// All that were judged on these pairs.
  std::vector<CombinationScore> seen(Half half) const;

 private:
  using Key = std::pair<Half, Combination>;
  ClaimBook book_for(Half half) const;
  CombinationScore judged(const Combination& combination, Half half) const;

  const std::vector<OpenPoint>& points_;
  const ClaimBook& book_;
  const TableSource tables_;
  const ParallelFor parallel_;
  std::map<Key, CombinationScore> scores_;
  std::map<Key, std::vector<int>> resampled_;
};

/// From the text to a combination that holds more statements on the chosen half.
///
///   With the matches fixed   The best change of one point, or where none helps of two points about groupers at once, as long
///                            as it is better and holds fewer statements in at most a fifth of 200 resamples over the
///                            pairs. A point may change back.
///   Over the matches         Every reading that changes matches is tried on top of the best so far, with that search on its
///                            matches; after the first round only those that alone held no fewer statements than the text.
std::vector<SearchStep> search_combinations(CombinationJudge& judge);

}  // namespace corral
