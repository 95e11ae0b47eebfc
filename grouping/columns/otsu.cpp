// SPDX-License-Identifier: MIT
#include "grouping/columns/otsu.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/columns/column_loops.h"
#include "grouping/columns/compatibility.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kTie = 1e-12;  // variances that differ by less differ by rounding

/// The cut of ordered classes that maximises n1 n2 (m1 - m2)^2: the last class of the lower part, or -1 if no cut has two
/// non-empty sides. Classes have a weight and a value each.
int best_cut(const std::vector<double>& weights, const std::vector<double>& values) {
  const std::size_t count = weights.size();
  std::vector<double> lower_weights(count), lowers(count);
  double weight = 0, sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    lower_weights[i] = weight += weights[i];
    lowers[i] = sum += weights[i] * values[i];
  }
  std::vector<double> variances(count);
  between_class_variances(lower_weights.data(), lowers.data(), {weight, sum}, count, variances.data());

  int best = -1;
  double to_beat = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    // An empty class ends no part: the cut below it is the same.
    if (!(variances[i] > to_beat) || !(weights[i] > 0) || !(weight - lower_weights[i] > 0)) continue;
    best = static_cast<int>(i), to_beat = variances[i] * (1 + kTie);
  }
  return best;
}

template <class Accept>
Indices rows_where(const std::vector<double>& scores, Accept accept) {
  std::vector<std::uint8_t> accepted(scores.size());
  std::transform(scores.begin(), scores.end(), accepted.begin(), accept);
  return marked_rows(accepted);
}

Indices all_rows(const std::vector<double>& scores) {
  return rows_where(scores, [](double) { return true; });
}

Indices select_exact(const std::vector<double>& scores) {
  std::vector<double> sorted = scores;
  std::sort(sorted.begin(), sorted.end());
  // Equal scores are one class: a cut between them is none. Measured from the smallest score: the variance does not
  // change, and far-away scores keep their digits.
  std::vector<double> values(sorted.size()), weights(sorted.size());
  std::size_t classes = 0, first = 0;
  for (std::size_t next = 1; next <= sorted.size(); ++next) {
    if (next < sorted.size() && !(sorted[first] < sorted[next])) continue;
    values[classes] = sorted[first] - sorted.front();
    weights[classes] = static_cast<double>(next - first);
    sorted[classes++] = sorted[first];
    first = next;
  }
  values.resize(classes), weights.resize(classes);
  const int cut = best_cut(weights, values);
  if (cut < 0) return all_rows(scores);
  const double below = sorted[static_cast<std::size_t>(cut)], next = sorted[static_cast<std::size_t>(cut) + 1];
  const double midpoint = below + (next - below) / 2;
  const double threshold = midpoint > below ? midpoint : next;  // neighbouring doubles have no midpoint
  return rows_where(scores, [=](double score) { return score >= threshold; });
}

/// The bin of a score among `bins` equal ones over [low, high]; what lies outside belongs to the first or the last.
int bin_of(double score, double low, double high, int bins) {
  return static_cast<int>(std::clamp(std::floor((score - low) / (high - low) * bins), 0.0, bins - 1.0));
}

/// The best cut of a histogram over [low, high]: the last bin of the lower class, or -1.
int histogram_cut(const std::vector<double>& scores, double low, double high, int bins) {
  std::vector<double> counts(static_cast<std::size_t>(bins), 0);
  for (const double score : scores) counts[static_cast<std::size_t>(bin_of(score, low, high, bins))] += 1;
  std::vector<double> numbers(counts.size());
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return best_cut(counts, numbers);
}

Indices select_bins100(const std::vector<double>& scores) {
  const auto extremes = std::minmax_element(scores.begin(), scores.end());
  const double low = *extremes.first, high = *extremes.second;
  if (!(high > low)) return all_rows(scores);
  const int cut = histogram_cut(scores, low, high, 100);
  return rows_where(scores, [=](double score) { return bin_of(score, low, high, 100) >= cut; });
}

Indices select_covis(const std::vector<double>& scores) {
  const int bins = static_cast<int>(std::lround(std::sqrt(static_cast<double>(scores.size()))));
  const int cut = histogram_cut(scores, 0, 1, bins);
  if (cut < 0) return all_rows(scores);
  const double threshold = cut / (bins - 1.0);
  return rows_where(scores, [=](double score) { return score > threshold; });
}

}  // namespace

double otsu_bins100_threshold(const std::vector<double>& scores) {
  if (scores.empty()) return 0;
  const auto extremes = std::minmax_element(scores.begin(), scores.end());
  const double low = *extremes.first, high = *extremes.second;
  if (!(high > low)) return low;
  return low + (high - low) / 100 * histogram_cut(scores, low, high, 100);
}

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
