// SPDX-License-Identifier: MIT
#include "grouping/otsu.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kTie = 1e-12;  // variances that differ by less differ by rounding

/// The cut of `count` ordered classes that maximises n1 n2 (m1 - m2)^2: the last class of the lower part, or -1 if no
/// cut has two non-empty sides. weight(i) and value(i) describe class i.
template <class Weight, class Value>
int best_cut(int count, Weight weight, Value value) {
  double total_weight = 0, total = 0;
  for (int i = 0; i < count; ++i) total_weight += weight(i), total += weight(i) * value(i);
  int best = -1;
  double best_variance = 0, lower_weight = 0, lower = 0;
  for (int i = 0; i + 1 < count; ++i) {
    lower_weight += weight(i);
    lower += weight(i) * value(i);
    const double upper_weight = total_weight - lower_weight;
    if (!(weight(i) > 0) || !(upper_weight > 0)) continue;  // an empty class ends no part: the cut below it is the same
    const double gap = lower / lower_weight - (total - lower) / upper_weight;
    const double variance = lower_weight * upper_weight * gap * gap;
    if (variance > best_variance * (1 + kTie)) best = i, best_variance = variance;
  }
  return best;
}

template <class Accept>
Indices rows_where(const std::vector<double>& scores, Accept accept) {
  Indices rows;
  for (std::size_t row = 0; row < scores.size(); ++row)
    if (accept(scores[row])) rows.push_back(static_cast<int>(row));
  return rows;
}

Indices all_rows(const std::vector<double>& scores) {
  return rows_where(scores, [](double) { return true; });
}

Indices select_exact(const std::vector<double>& scores) {
  std::vector<double> sorted = scores;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> values, weights;  // equal scores are one class: a cut between them is none
  for (const double score : sorted) {
    if (values.empty() || values.back() < score) values.push_back(score), weights.push_back(0);
    weights.back() += 1;
  }
  const int cut = best_cut(
      static_cast<int>(values.size()), [&](int i) { return weights[static_cast<std::size_t>(i)]; },
      // measured from the smallest score: the variance does not change and far-away scores keep their digits
      [&](int i) { return values[static_cast<std::size_t>(i)] - values.front(); });
  if (cut < 0) return all_rows(scores);
  const double below = values[static_cast<std::size_t>(cut)], next = values[static_cast<std::size_t>(cut) + 1];
  const double midpoint = below + (next - below) / 2;
  const double threshold = midpoint > below ? midpoint : next;  // neighbouring doubles have no midpoint
  return rows_where(scores, [&](double score) { return score >= threshold; });
}

/// The bin of a score among `bins` equal ones over [low, high]; what lies outside belongs to the first or the last.
int bin_of(double score, double low, double high, int bins) {
  return static_cast<int>(std::clamp(std::floor((score - low) / (high - low) * bins), 0.0, bins - 1.0));
}

/// The best cut of a histogram over [low, high]: the last bin of the lower class, or -1.
int histogram_cut(const std::vector<double>& scores, double low, double high, int bins) {
  std::vector<double> counts(static_cast<std::size_t>(bins), 0);
  for (const double score : scores) counts[static_cast<std::size_t>(bin_of(score, low, high, bins))] += 1;
  return best_cut(
      bins, [&](int i) { return counts[static_cast<std::size_t>(i)]; }, [](int i) { return static_cast<double>(i); });
}

Indices select_bins100(const std::vector<double>& scores) {
  const auto extremes = std::minmax_element(scores.begin(), scores.end());
  const double low = *extremes.first, high = *extremes.second;
  if (!(high > low)) return all_rows(scores);
  const int cut = histogram_cut(scores, low, high, 100);
  return rows_where(scores, [&](double score) { return bin_of(score, low, high, 100) >= cut; });
}

Indices select_covis(const std::vector<double>& scores) {
  const int bins = static_cast<int>(std::lround(std::sqrt(static_cast<double>(scores.size()))));
  const int cut = histogram_cut(scores, 0, 1, bins);
  if (cut < 0) return all_rows(scores);
  const double threshold = cut / (bins - 1.0);
  return rows_where(scores, [&](double score) { return score > threshold; });
}

}  // namespace

Indices select_by_otsu(const std::vector<double>& scores, OtsuRule rule) {
  for (const double score : scores)
    if (!std::isfinite(score)) throw InvalidInput("select_by_otsu", "score", score, "a finite number");
  if (scores.empty()) return {};
  switch (rule) {
    case OtsuRule::Bins100:
      return select_bins100(scores);
    case OtsuRule::Covis:
      return select_covis(scores);
    case OtsuRule::Exact:
      break;
  }
  return select_exact(scores);
}

}  // namespace corral
