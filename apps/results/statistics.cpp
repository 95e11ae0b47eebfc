// SPDX-License-Identifier: MIT
#include "apps/results/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/error.h"

namespace corral {
namespace {

double normal_cdf(double z) { return boost::math::cdf(boost::math::normal(), z); }
double normal_tail(double z) { return boost::math::cdf(boost::math::complement(boost::math::normal(), z)); }
double chi_square_tail(double value, int freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), value));
}

/// As quantile_of.
double quantile_of_sorted(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= sorted.size()) return sorted.back();
  const double share = place - static_cast<double>(below), step = sorted[below + 1] - sorted[below];
  return share > 0 && step > 0 ? sorted[below] + share * step : sorted[below];  // values may be infinite
}

/// How often each sum of positive ranks occurs among the 2^n signs of the ranks 1 .. n; exact up to n = 53.
std::vector<double> rank_sum_counts(int n) {
  std::vector<double> counts(static_cast<std::size_t>(n * (n + 1) / 2 + 1), 0.0);
  counts[0] = 1;
  for (int rank = 1; rank <= n; ++rank)
    for (std::size_t sum = counts.size() - 1; sum >= static_cast<std::size_t>(rank); --sum)
      counts[sum] += counts[sum - static_cast<std::size_t>(rank)];
  return counts;
}

/// sum of t^3 - t over groups of t equal values
double tie_term(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double term = 0;
  for (std::size_t first = 0, next = 0; first < values.size(); first = next) {
    while (next < values.size() && values[next] == values[first]) ++next;
    const auto equal = static_cast<double>(next - first);
    term += equal * (equal * equal - 1);
  }
  return term;
}

void check_scores(const std::vector<std::vector<double>>& scores) {
  if (scores.size() < 2)
    throw InvalidInput("compare_ranks", "scores", std::to_string(scores.size()), "2 groupers or more");
  for (const auto& row : scores) {
    if (row.empty() || row.size() != scores[0].size())
      throw InvalidInput("compare_ranks", "scores", std::to_string(row.size()) + " pairs", "as many for each grouper");
    for (const double score : row)
      if (!std::isfinite(score)) throw InvalidInput("compare_ranks", "scores", score, "finite numbers");
  }
}

}  // namespace

double quantile_of(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return quantile_of_sorted(values, p);
}

std::vector<double> shared_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, next = 0; first < order.size(); first = next) {
    while (next < order.size() && !(values[order[first]] < values[order[next]])) ++next;
    for (std::size_t i = first; i < next; ++i) ranks[order[i]] = static_cast<double>(first + next + 1) / 2;
  }
  return ranks;
}

double spearman(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw InvalidInput("spearman", "y", std::to_string(y.size()) + " values", "as many as x");
  const std::vector<double> a = shared_ranks(x), b = shared_ranks(y);
  const double middle = (static_cast<double>(x.size()) + 1) / 2;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    xx += (a[i] - middle) * (a[i] - middle);
    yy += (b[i] - middle) * (b[i] - middle);
    xy += (a[i] - middle) * (b[i] - middle);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : std::numeric_limits<double>::quiet_NaN();
}

WilcoxonTest wilcoxon_signed_rank(const std::vector<double>& differences) {
  std::vector<double> sizes, signs;
  for (const double difference : differences) {
    if (difference == 0) continue;
    sizes.push_back(std::abs(difference));
    signs.push_back(difference);
  }
  if (sizes.empty()) return {};
  const std::vector<double> ranks = shared_ranks(sizes);
  double positive = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) positive += signs[i] > 0 ? ranks[i] : 0;
  const auto n = static_cast<double>(sizes.size());
  WilcoxonTest test;
  test.statistic = std::min(positive, n * (n + 1) / 2 - positive);
  const double ties = tie_term(sizes);
  test.is_exact = differences.size() <= 50 && sizes.size() == differences.size() && ties == 0;
  if (test.is_exact) {
    const std::vector<double> counts = rank_sum_counts(static_cast<int>(sizes.size()));
    const auto end = counts.begin() + static_cast<std::ptrdiff_t>(test.statistic) + 1;
    test.p = std::min(1.0, 2 * std::accumulate(counts.begin(), end, 0.0) / std::exp2(n));
  } else {
    const double variance = (n * (n + 1) * (2 * n + 1) - ties / 2) / 24;
    test.p = std::min(1.0, 2 * normal_tail(std::abs(test.statistic - n * (n + 1) / 4) / std::sqrt(variance)));
  }
  return test;
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - i) * p[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

McNemarTest mcnemar(int only_first, int only_second) {
  if (only_first < 0 || only_second < 0)
    throw InvalidInput("mcnemar", "counts", std::min(only_first, only_second), "at least 0");
  McNemarTest test;
  const double discordant = static_cast<double>(only_first) + only_second;
  if (discordant == 0) return test;
  const boost::math::binomial coin(discordant, 0.5);
  test.exact_p = std::min(1.0, 2 * boost::math::cdf(coin, std::min(only_first, only_second)));
  const double off = std::max(0.0, std::abs(static_cast<double>(only_first) - only_second) - 1);
  test.chi_square = off * off / discordant;
  test.chi_square_p = chi_square_tail(test.chi_square, 1);
  return test;
}

std::pair<double, double> wilson_interval(double successes, int trials) {
  constexpr double kZ = 1.959963984540054;  // normal quantile of 97.5 %
  if (trials <= 0) return {0, 1};
  const double n = trials, share = successes / n, z2 = kZ * kZ;
  const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kZ / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
  return {successes > 0 ? std::max(0.0, middle - half) : 0, successes < n ? std::min(1.0, middle + half) : 1};
}

double studentized_range_cdf(double range, int groups) {
  if (groups < 2) throw InvalidInput("studentized_range", "groups", groups, "at least 2");
  if (!(range > 0)) return 0;
  // P(range) = k integral of phi(z) (Phi(z) - Phi(z - range))^(k-1): the trapezoid rule is exact to rounding, as the
  // integrand is smooth and vanishes at both ends.
  constexpr double kStep = 1.0 / 16, kEnd = 9;
  double sum = 0;
  for (int i = static_cast<int>(-kEnd / kStep); i <= static_cast<int>(kEnd / kStep); ++i) {
    const double z = i * kStep;
    sum += std::exp(-z * z / 2) * std::pow(normal_cdf(z) - normal_cdf(z - range), groups - 1);
  }
  return std::min(1.0, groups * kStep * sum / std::sqrt(2 * 3.14159265358979323846));
}

double studentized_range_quantile(double p, int groups) {
  if (!(p > 0 && p < 1)) throw InvalidInput("studentized_range_quantile", "p", p, "between 0 and 1");
  double low = 0, high = 1;
  while (high < 64 && studentized_range_cdf(high, groups) < p) high *= 2;
  while (true) {
    const double middle = (low + high) / 2;
    if (!(low < middle && middle < high)) return middle;
    (studentized_range_cdf(middle, groups) < p ? low : high) = middle;
  }
}

RankComparison compare_ranks(const std::vector<std::vector<double>>& scores) {
  check_scores(scores);
  const std::size_t methods = scores.size(), pairs = scores[0].size();
  const auto k = static_cast<double>(methods), n = static_cast<double>(pairs);
  RankComparison comparison;
  comparison.average_ranks.assign(methods, 0.0);
  double ties = 0, squares = 0;
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    std::vector<double> losses;
    for (const auto& row : scores) losses.push_back(-row[pair]);
    const std::vector<double> ranks = shared_ranks(losses);
    for (std::size_t i = 0; i < methods; ++i) comparison.average_ranks[i] += ranks[i];
    ties += tie_term(losses);
  }
  for (double& rank : comparison.average_ranks) {
    squares += rank * rank;
    rank /= n;
  }
  const double untied = 1 - ties / (k * (k * k - 1) * n);
  if (untied > 0) {
    comparison.chi_square = (12 / (k * n * (k + 1)) * squares - 3 * n * (k + 1)) / untied;
    comparison.p = chi_square_tail(std::max(0.0, comparison.chi_square), static_cast<int>(methods) - 1);
  }
  comparison.critical_difference =
      studentized_range_quantile(0.95, static_cast<int>(methods)) / std::sqrt(2.0) * std::sqrt(k * (k + 1) / (6 * n));
  std::vector<int> order(methods);
  std::iota(order.begin(), order.end(), 0);
  const auto rank_of = [&](int method) { return comparison.average_ranks[static_cast<std::size_t>(method)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank_of(a) < rank_of(b); });
  for (std::size_t first = 0, reached = 0; first < methods; ++first) {
    std::size_t end = first;
    while (end < methods && rank_of(order[end]) - rank_of(order[first]) <= comparison.critical_difference) ++end;
    if (end > reached && end - first > 1)
      comparison.cliques.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(first),
                                      order.begin() + static_cast<std::ptrdiff_t>(end));
    reached = std::max(reached, end);
  }
  return comparison;
}

}  // namespace corral
