// SPDX-License-Identifier: MIT
#include "apps/reproduce/search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

namespace corral {
namespace {

constexpr double kMarginCut = 0.1;

/// Margins differ by rounding between orders of summation only; what is closer is equal.
constexpr double kSameMargin = 1e-9;

ClaimStudy study_of(const JudgedTables& tables) {
  ClaimStudy study;
  for (std::size_t i = 0; i < tables.tables.size(); ++i)
    study.add({&tables.tables[i], tables.agreement[i], tables.keypoints[i]});
  return study;
}

int count_holding(const std::vector<Verdict>& verdicts) {
  return static_cast<int>(std::count(verdicts.begin(), verdicts.end(), Verdict::Holds));
}

/// A point and the reading that it changes to.
using Move = std::pair<std::size_t, int>;

Combination with(Combination combination, const Move& move) {
  combination[move.first] = move.second;
  return combination;
}

class Search {
 public:
  explicit Search(CombinationJudge& judge) : judge_(judge), points_(judge.points()) {}

  std::vector<SearchStep> run() {
    const Combination text(points_.size(), 0);
    std::vector<SearchStep> best = with_matches_fixed({{judge_.score(text, Half::Chosen), 0}});
    const int alone = judge_.score(text, Half::Chosen).holds;
    for (bool is_first = true;; is_first = false) {
      std::optional<std::vector<SearchStep>> found;
      for (const Move& move : moves(true)) {
        if (best.back().score.combination[move.first] == move.second) continue;
        if (!is_first && judge_.score(with(text, move), Half::Chosen).holds < alone) continue;
        std::vector<SearchStep> path = best;
        path.push_back(step(best.back().score, with(best.back().score.combination, move)));
        path = with_matches_fixed(std::move(path));
        path.back().share_worse = share_worse(best.back().score, path.back().score);
        if (!is_gain(best.back().score, path.back())) continue;
        if (!found || path.back().score.is_better_than(found->back().score)) found = std::move(path);
      }
      if (!found) return best;
      best = std::move(*found);
    }
  }

 private:
  std::vector<SearchStep> with_matches_fixed(std::vector<SearchStep> path) {
    while (true) {
      const CombinationScore& from = path.back().score;
      std::optional<SearchStep> found = best_of(from, singles(from));
      if (!found) found = best_of(from, doubles(from));
      if (!found) return path;
      path.push_back(std::move(*found));
    }
  }

  std::vector<Move> moves(bool of_matches) const {
    std::vector<Move> all;
    for (std::size_t point = 0; point < points_.size(); ++point) {
      const auto& readings = points_[point].readings;
      if (std::any_of(readings.begin(), readings.end(), changes_matches) != of_matches) continue;
      for (std::size_t reading = 0; reading < readings.size(); ++reading)
        all.emplace_back(point, static_cast<int>(reading));
    }
    return all;
  }

  std::vector<Combination> singles(const CombinationScore& from) const {
    std::vector<Combination> all;
    for (const Move& move : moves(false))
      if (from.combination[move.first] != move.second) all.push_back(with(from.combination, move));
    return all;
  }

  std::vector<Combination> doubles(const CombinationScore& from) const {
    std::vector<Combination> all;
    for (const Move& first : moves(false))
      for (const Move& second : moves(false))
        if (first.first < second.first && is_of_groupers(first) && is_of_groupers(second) &&
            from.combination[first.first] != first.second && from.combination[second.first] != second.second)
          all.push_back(with(with(from.combination, first), second));
    return all;
  }

  /// Whether the point is about what groupers do, not about means.
  bool is_of_groupers(const Move& move) const {
    const auto& readings = points_[move.first].readings;
    return std::any_of(readings.begin(), readings.end(),
                       [](const Reading& reading) { return !reading.options.empty(); });
  }

  /// The best of them that is a gain beyond the noise.
  std::optional<SearchStep> best_of(const CombinationScore& from, const std::vector<Combination>& candidates) {
    judge_.score_all(candidates, Half::Chosen);
    std::vector<CombinationScore> better;
    for (const Combination& candidate : candidates)
      if (const CombinationScore& score = judge_.score(candidate, Half::Chosen); score.is_better_than(from))
        better.push_back(score);
    std::stable_sort(better.begin(), better.end(),
                     [](const CombinationScore& a, const CombinationScore& b) { return a.is_better_than(b); });
    for (const CombinationScore& score : better)
      if (SearchStep taken = step(from, score.combination); is_gain(from, taken)) return taken;
    return std::nullopt;
  }

  SearchStep step(const CombinationScore& from, const Combination& to) {
    const CombinationScore& score = judge_.score(to, Half::Chosen);
    return {score, share_worse(from, score)};
  }

  double share_worse(const CombinationScore& from, const CombinationScore& to) {
    const std::vector<int> before = judge_.resampled(from.combination, Half::Chosen),
                           after = judge_.resampled(to.combination, Half::Chosen);
    int worse = 0;
    for (std::size_t i = 0; i < before.size(); ++i) worse += after[i] < before[i];
    return static_cast<double>(worse) / static_cast<double>(before.size());
  }

  static bool is_gain(const CombinationScore& from, const SearchStep& to) {
    return to.score.holds > from.holds && to.share_worse <= kMostWorse;
  }

  CombinationJudge& judge_;
  const std::vector<OpenPoint>& points_;
};

}  // namespace

bool CombinationScore::is_better_than(const CombinationScore& other) const {
  if (holds != other.holds) return holds > other.holds;
  if (std::abs(margin - other.margin) > kSameMargin) return margin > other.margin;
  const int here = departures(combination), there = departures(other.combination);
  return std::tie(here, combination) < std::tie(there, other.combination);
}

/// Half of the pairs are enough for a level where half as many are there.
ClaimBook CombinationJudge::book_for(Half half) const {
  ClaimBook book = book_;
  if (half != Half::All) book.least_pairs = (book.least_pairs + 1) / 2;
  return book;
}

const CombinationScore& CombinationJudge::score(const Combination& combination, Half half) {
  score_all({combination}, half);
  return scores_.at({half, combination});
}

void CombinationJudge::score_all(const std::vector<Combination>& combinations, Half half) {
  std::vector<Combination> left;
  for (const Combination& combination : combinations)
    if (!scores_.count({half, combination}) && std::find(left.begin(), left.end(), combination) == left.end())
      left.push_back(combination);
  if (left.empty()) return;
  std::vector<CombinationScore> scores(left.size());
  scores.front() = judged(left.front(), half);  // the source may have to run what is missing
  parallel_(static_cast<int>(left.size()) - 1, [&](int i) {
    const auto place = static_cast<std::size_t>(i) + 1;
    scores[place] = judged(left[place], half);
  });
  for (std::size_t i = 0; i < left.size(); ++i) scores_.emplace(Key{half, left[i]}, std::move(scores[i]));
}

CombinationScore CombinationJudge::judged(const Combination& combination, Half half) const {
  const ClaimBook book = book_for(half);
  const JudgedTables tables = tables_(combination, half);
  const ClaimStudy study = study_of(tables);
  CombinationScore score;
  score.combination = combination;
  score.outcomes = ClaimOutcomes(book, study, settings_of(points(), combination).averaging).outcomes();
  for (const ClaimOutcome& outcome : score.outcomes) {
    score.holds += outcome.verdict == Verdict::Holds;
    score.margin += std::clamp(outcome.margin, -kMarginCut, kMarginCut);
  }
  return score;
}

const std::vector<int>& CombinationJudge::resampled(const Combination& combination, Half half) {
  std::vector<int>& counts = resampled_[{half, combination}];
  if (!counts.empty()) return counts;
  const ClaimBook book = book_for(half);
  const JudgedTables tables = tables_(combination, half);
  const ClaimStudy study = study_of(tables);
  const ClaimOutcomes outcomes(book, study, settings_of(points(), combination).averaging);
  counts.resize(kStepResamples);
  parallel_(kStepResamples,
            [&](int repeat) { counts[static_cast<std::size_t>(repeat)] = count_holding(outcomes.resampled(repeat)); });
  return counts;
}

std::vector<CombinationScore> CombinationJudge::seen(Half half) const {
  std::vector<CombinationScore> all;
  for (const auto& [key, score] : scores_)
    if (key.first == half) all.push_back(score);
  return all;
}

std::vector<SearchStep> search_combinations(CombinationJudge& judge) { return Search(judge).run(); }

}  // namespace corral
