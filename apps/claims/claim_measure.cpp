// SPDX-License-Identifier: MIT
#include "apps/claims/claim_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/results/statistics.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

using Numbers = ClaimMeasure::Numbers;

Numbers difference(const Numbers& a, const Numbers& b) {
  Numbers result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i] - b[i]);
  return result;
}

/// 1 - after / before: how much of each number is lost.
Numbers relative_loss(const Numbers& before, const Numbers& after) {
  Numbers result;
  for (std::size_t i = 0; i < before.size(); ++i) result.push_back(before[i] > 0 ? 1 - after[i] / before[i] : kAbsent);
  return result;
}

/// The sum of columns over the rows that are judged: those where `judged` has a number.
double sum_of(const std::vector<const RowNumbers*>& columns, const std::vector<int>& rows, const RowNumbers& judged) {
  double sum = 0;
  for (const int row : rows)
    for (const RowNumbers* column : columns)
      if (!std::isnan(judged[static_cast<std::size_t>(row)])) sum += (*column)[static_cast<std::size_t>(row)];
  return sum;
}

/// Least-squares slope of y over x.
double slope(const Numbers& x, const Numbers& y) {
  const double x_mean = mean_of(x), y_mean = mean_of(y);
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x_mean) * (x[i] - x_mean);
    xy += (x[i] - x_mean) * (y[i] - y_mean);
  }
  return xx > 0 ? xy / xx : kAbsent;
}

/// Spearman's correlation; what does not change does not follow.
double trend(const Numbers& x, const Numbers& y) {
  const double correlation = spearman(x, y);
  return std::isnan(correlation) ? 0 : correlation;
}

/// What a series over the levels says: its range, its steps, its trend.
double of_one_series(Take take, const Numbers& x, const Numbers& y) {
  if (present_in(y) < static_cast<int>(y.size())) return kAbsent;
  switch (take) {
    case Take::Range:
      return *std::max_element(y.begin(), y.end()) - *std::min_element(y.begin(), y.end());
    case Take::Spearman:
      return trend(x, y);
    case Take::Slope:
      return slope(x, y);
    default: {
      double largest = 0;
      for (std::size_t i = 1; i < y.size(); ++i)
        largest = std::max(largest, (take == Take::LargestRise ? 1 : -1) * (y[i] - y[i - 1]));
      return largest;
    }
  }
}

}  // namespace

Scale ClaimMeasure::scale() const {
  const bool is_time = part_.of.is_time();
  const bool is_logarithm = is_time && !part_.over_pairs && part_.take != Take::Slope && part_.take < Take::Wins;
  return {is_time ? std::log(1 + book_.time_tau) : book_.tau, is_logarithm,
          part_.of.kind == Quantity::Kind::Measure && part_.of.measure->better == Better::Smaller};
}

std::vector<std::string> ClaimMeasure::labels() const {
  if (part_.take != Take::EachLevel) return {""};
  std::vector<std::string> labels;
  for (const Level& level : experiments_.front()) labels.push_back(level.source->table->level.label);
  return labels;
}

Numbers ClaimMeasure::of_level(const Level& level, const Draws& draws) const {
  const std::vector<int>& rows = draws[level.source->slot];
  Numbers numbers;
  for (std::size_t i = 0; i < level.columns.size(); ++i) {
    double number = level.columns[i] ? 0 : kAbsent;
    for (const Ratio& ratio : level.ratios[i]) {
      if (!level.columns[i]) break;
      const RowNumbers& first = *ratio.above.front();
      number += ratio.below.empty() ? mean_of(first, rows)
                                    : sum_of(ratio.above, rows, first) / sum_of(ratio.below, rows, first);
    }
    number /= static_cast<double>(level.ratios[i].size());
    numbers.push_back(part_.of.is_time() ? std::log(number) : number);
  }
  return part_.lead ? leads_of(numbers) : numbers;
}

Numbers ClaimMeasure::mean(const Levels& levels, const Draws& draws) const {
  Numbers sums;
  for (const Level& level : levels) {
    const Numbers numbers = of_level(level, draws);
    sums.resize(numbers.size(), 0.0);
    for (std::size_t i = 0; i < numbers.size(); ++i) sums[i] += numbers[i];
  }
  for (double& sum : sums) sum /= static_cast<double>(levels.size());
  return sums;
}

ClaimMeasure::Levels ClaimMeasure::within(const Levels& levels, const Range& range, bool from_the_end) {
  if (!range) return {from_the_end ? levels.back() : levels.front()};
  Levels inside;
  for (const Level& level : levels) {
    if (is_within(level.source->table->level, range->first, range->second)) inside.push_back(level);
  }
  return inside;
}

Numbers ClaimMeasure::of_ends(const Draws& draws) const {
  const Numbers first = mean(within(experiments_.front(), part_.first, false), draws);
  const Numbers last = mean(within(experiments_.front(), part_.last, true), draws);
  return part_.take == Take::Rise ? difference(last, first) : relative_loss(first, last);
}

Numbers ClaimMeasure::of_experiments(const Draws& draws) const {
  const Numbers first = mean(experiments_.front(), draws);
  Numbers others(first.size(), 0.0);  // the mean over them
  for (const Levels& levels : with_) {
    const Numbers other = mean(levels, draws);
    for (std::size_t i = 0; i < others.size(); ++i) others[i] += other[i] / static_cast<double>(with_.size());
  }
  if (part_.take == Take::Rise) return difference(others, first);
  if (part_.take == Take::RelativeDrop) return relative_loss(first, others);
  return {spearman(first, others)};
}

Numbers ClaimMeasure::of_series(const Draws& draws) const {
  Numbers x;
  std::vector<Numbers> series;  // of each method
  for (const Level& level : experiments_.front()) {
    const LevelTable& table = *level.source->table;
    const double matches = mean_of(*table.column(measure("matches"), ""));
    x.push_back(part_.take == Take::Slope ? std::log(std::isnan(matches) ? table.level.middle() : matches)
                                          : table.level.middle());
    const Numbers numbers = of_level(level, draws);
    series.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) series[i].push_back(numbers[i]);
  }
  Numbers result;
  for (const Numbers& y : series) result.push_back(of_one_series(part_.take, x, y));
  return result;
}

Numbers ClaimMeasure::of_steps(const Draws& draws) const {
  const Levels& levels = experiments_.front();
  Numbers least(levels.front().columns.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    for (std::size_t method = 0; method < least.size(); ++method) {
      const RowNumbers *here = levels[i].columns[method], *next = levels[i + 1].columns[method];
      Numbers steps;
      for (const int row : draws[levels[i].source->slot]) {
        const int partner = levels[i].partners[static_cast<std::size_t>(row)];
        if (partner >= 0 && here && next)
          steps.push_back((*next)[static_cast<std::size_t>(partner)] - (*here)[static_cast<std::size_t>(row)]);
      }
      const double step = mean_of(steps);
      least[method] = std::isnan(step) || std::isnan(least[method]) ? kAbsent : std::min(least[method], step);
    }
  return least;
}

Numbers ClaimMeasure::of_cells(const Draws& draws) const {
  Numbers sums(book_.methods.size(), 0.0);
  double cells = 0;
  for (const Levels& levels : experiments_)
    for (const Level& level : levels) {
      const Numbers numbers = of_level(level, draws);
      if (present_in(numbers) < static_cast<int>(numbers.size())) return Numbers(sums.size(), kAbsent);
      const std::vector<int> ranks = ranks_of(numbers, scale());
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += part_.take == Take::Wins ? ranks[i] == 1 : ranks[i];
      ++cells;
    }
  if (part_.take == Take::MeanRank)
    for (double& sum : sums) sum /= cells;
  return sums;
}

Numbers ClaimMeasure::of_pairs(const Draws& draws) const {
  Numbers result;
  for (std::size_t i = 0; i < experiments_.front().front().columns.size(); ++i) {
    Numbers numbers, values;
    double rows = 0;
    for (const Levels& levels : experiments_)
      for (const Level& level : levels) {
        const LevelTable& table = *level.source->table;
        const RowNumbers& inlier_ratios = *table.column(measure("inlier_ratio"), "");
        rows += static_cast<double>(draws[level.source->slot].size());
        if (!level.columns[i] || part_.take == Take::Count) continue;
        for (const int row : draws[level.source->slot]) {
          const auto place = static_cast<std::size_t>(row);
          const double number = (*level.columns[i])[place], ratio = inlier_ratios[place];
          const bool is_any = part_.inlier_from <= 0 && part_.inlier_below > 1;
          if (std::isnan(number) || !(is_any || (ratio >= part_.inlier_from && ratio < part_.inlier_below))) continue;
          if (part_.take == Take::Spearman && std::isnan(table.value[place])) continue;
          numbers.push_back(number);
          values.push_back(table.value[place]);
        }
      }
    if (part_.take == Take::Count)
      result.push_back(rows);
    else
      result.push_back(static_cast<int>(numbers.size()) < book_.least_pairs ? kAbsent : of_numbers(numbers, values));
  }
  return result;
}

double ClaimMeasure::of_numbers(const Numbers& numbers, const Numbers& values) const {
  switch (part_.take) {
    case Take::Mean:
      return mean_of(numbers);
    case Take::Percentile:
      return quantile_of(numbers, part_.percent / 100);
    default:
      return trend(values, numbers);
  }
}

std::vector<Numbers> ClaimMeasure::numbers(const Draws& draws) const {
  if (part_.over_pairs) return {of_pairs(draws)};
  if (!with_.empty()) return {of_experiments(draws)};
  switch (part_.take) {
    case Take::EachLevel: {
      std::vector<Numbers> all;
      for (const Level& level : experiments_.front()) all.push_back(of_level(level, draws));
      return all;
    }
    case Take::Mean:
      return {mean(experiments_.front(), draws)};
    case Take::Rise:
    case Take::RelativeDrop:
      return {of_ends(draws)};
    case Take::LeastStep:
      return {of_steps(draws)};
    case Take::Wins:
    case Take::MeanRank:
      return {of_cells(draws)};
    default:
      return {of_series(draws)};
  }
}

}  // namespace corral
