// SPDX-License-Identifier: MIT
#include "apps/reproduce/reproduction.h"

#include <algorithm>

namespace corral {
namespace {

bool holds(const CombinationScore& score, std::size_t claim) { return score.outcomes[claim].verdict == Verdict::Holds; }

StatementClass class_of(const std::vector<CombinationScore>& alone, std::size_t claim) {
  int holding = 0, decided = 0;
  for (const CombinationScore& score : alone) {
    holding += holds(score, claim);
    decided += score.outcomes[claim].verdict != Verdict::Undecidable;
  }
  if (decided == 0) return StatementClass::Undecided;
  if (holding == 0) return StatementClass::Never;
  return holding == static_cast<int>(alone.size()) ? StatementClass::Robust : StatementClass::Depends;
}

/// The claims whose verdict one of the readings of a point turns, the others read as in the text.
std::vector<int> decided_by(std::size_t point, const Reproduction& of) {
  std::vector<int> claims;
  for (std::size_t claim = 0; claim < of.claims.size(); ++claim)
    if (std::any_of(of.alone.begin(), of.alone.end(), [&](const CombinationScore& score) {
          return score.combination[point] > 0 && holds(score, claim) != holds(of.alone.front(), claim);
        }))
      claims.push_back(static_cast<int>(claim));
  return claims;
}

int most_holding(const std::vector<CombinationScore>& judged) {
  int most = 0;
  for (const CombinationScore& score : judged) most = std::max(most, score.holds);
  return most;
}

void find_bounds(const std::vector<CombinationScore>& judged, Reproduction& of) {
  const std::size_t claims = of.claims.size();
  of.combinations = static_cast<int>(judged.size());
  of.is_bound.assign(claims, false);
  std::vector<std::vector<bool>> together(claims, std::vector<bool>(claims, false));
  for (const CombinationScore& score : judged)
    for (std::size_t a = 0; a < claims; ++a) {
      if (!holds(score, a)) continue;
      of.is_bound[a] = true;
      for (std::size_t b = a + 1; b < claims; ++b)
        if (holds(score, b)) together[a][b] = true;
    }
  for (std::size_t a = 0; a < claims; ++a)
    for (std::size_t b = a + 1; b < claims; ++b)
      if (of.is_bound[a] && of.is_bound[b] && !together[a][b])
        of.never_together.emplace_back(static_cast<int>(a), static_cast<int>(b));
}

}  // namespace

std::string class_name(StatementClass of) {
  switch (of) {
    case StatementClass::Robust:
      return "robust";
    case StatementClass::Depends:
      return "depends";
    case StatementClass::Never:
      return "never";
    default:
      return "undecided";
  }
}

Reproduction reproduce(const std::vector<OpenPoint>& points, const ClaimBook& book, const TableSource& tables,
                       const ParallelFor& parallel) {
  CombinationJudge judge(points, book, tables, parallel);
  const auto judged = [&](const Combination& combination) {
    return JudgedCombination{judge.score(combination, Half::All), judge.score(combination, Half::Chosen),
                             judge.score(combination, Half::HeldOut)};
  };
  Reproduction made;
  made.points = points;
  made.claims = book.claims;
  const Combination text(made.points.size(), 0);
  made.alone.push_back(judge.score(text, Half::All));
  for (std::size_t point = 0; point < made.points.size(); ++point)
    for (std::size_t reading = 1; reading < made.points[point].readings.size(); ++reading) {
      Combination alone = text;
      alone[point] = static_cast<int>(reading);
      made.alone.push_back(judge.score(alone, Half::All));
    }
  made.steps = search_combinations(judge);
  made.text = judged(text);
  made.found = judged(made.steps.back().score.combination);
  std::vector<Combination> seen;
  for (const CombinationScore& score : judge.seen(Half::Chosen)) seen.push_back(score.combination);
  for (const Half half : {Half::All, Half::HeldOut}) judge.score_all(seen, half);
  for (std::size_t claim = 0; claim < made.claims.size(); ++claim) made.classes.push_back(class_of(made.alone, claim));
  for (std::size_t point = 0; point < made.points.size(); ++point) made.decides.push_back(decided_by(point, made));
  find_bounds(judge.seen(Half::All), made);
  made.most = most_holding(judge.seen(Half::All)), made.most_chosen = most_holding(judge.seen(Half::Chosen));
  made.most_held_out = most_holding(judge.seen(Half::HeldOut));
  return made;
}

}  // namespace corral
