// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/reproduce/search.h"

namespace corral {

/// What the readings make of a statement.
enum class StatementClass {
  Robust,     ///< holds under every reading alone
  Depends,    ///< under some
  Never,      ///< under none
  Undecided,  ///< could be decided under none
};
std::string class_name(StatementClass of);

/// A combination on all pairs and on both halves.
struct JudgedCombination {
  CombinationScore all, chosen, held_out;
};

/// The whole answer. Of claims and points, numbers are places in the book and among the points.
struct Reproduction {
  std::vector<OpenPoint> points;
  std::vector<Claim> claims;
  JudgedCombination text, found;
  std::vector<CombinationScore> alone;    ///< on all pairs: the text, then each other reading alone, in order
  std::vector<SearchStep> steps;          ///< on the chosen half; the first is the text
  std::vector<StatementClass> classes;    ///< of each claim
  std::vector<std::vector<int>> decides;  ///< of each point: the claims that one of its readings alone turns
  std::vector<bool> is_bound;             ///< of each claim: whether it holds in any combination that was judged
  std::vector<std::pair<int, int>>
      never_together;    ///< claims that hold in some such combination each, but in none both
  int combinations = 0;  ///< so many were judged
  int most = 0, most_chosen = 0, most_held_out = 0;  ///< statements that one of them holds on all pairs, on each half
};

/// Judges the readings alone and searches their combinations.
Reproduction reproduce(const std::vector<OpenPoint>& points, const ClaimBook& book, const TableSource& tables,
                       const ParallelFor& parallel = one_by_one);

}  // namespace corral
