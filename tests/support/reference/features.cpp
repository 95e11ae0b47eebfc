// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "tests/support/reference/groupers.h"

namespace corral::reference {
namespace {

/// n1 n2 (m1 - m2)^2 with the first `cut` of the ascending values as the lower class.
double between_class_variance(const std::vector<double>& values, std::size_t cut) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (i < cut ? low : high) += values[i];
  const auto n1 = static_cast<double>(cut), n2 = static_cast<double>(values.size() - cut);
  return n1 * n2 * (low / n1 - high / n2) * (low / n1 - high / n2);
}

/// Size of the lower class at the best gap of the ascending values; 0 if all are equal. Ties go to the lowest gap, and
/// what rounding tells apart is a tie: counts and scores on a grid have many.
std::size_t best_cut(const std::vector<double>& values) {
  std::size_t best = 0;
  double largest = 0;
  for (std::size_t cut = 1; cut < values.size(); ++cut) {
    if (values[cut - 1] == values[cut]) continue;
    const double variance = between_class_variance(values, cut);
    if (variance > largest * (1 + 1e-12)) best = cut, largest = variance;
  }
  return best;
}

}  // namespace

Indices rows_by_otsu(const std::vector<double>& scores, OtsuRule rule) {
  const auto count = static_cast<int>(scores.size());
  if (count == 0) return {};
  const double smallest = *std::min_element(scores.begin(), scores.end());
  const double largest = *std::max_element(scores.begin(), scores.end());
  const int bins = rule == OtsuRule::Bins100 ? 100 : static_cast<int>(std::lround(std::sqrt(count)));
  std::vector<double> values = scores;  // what is cut in two: the scores, or the numbers of their bins
  for (double& value : values) {
    if (rule == OtsuRule::Exact || smallest == largest) continue;
    const double place = rule == OtsuRule::Bins100 ? (value - smallest) / (largest - smallest) : value;
    value = std::min(std::max(std::floor(place * bins), 0.0), bins - 1.0);
  }
  std::vector<double> ascending = values;
  std::sort(ascending.begin(), ascending.end());
  const std::size_t cut = best_cut(ascending);
  Indices selected;
  for (int row = 0; row < count; ++row) {
    const auto i = static_cast<std::size_t>(row);
    bool keep = true;
    if (cut > 0 && rule == OtsuRule::Exact) keep = scores[i] >= (ascending[cut - 1] + ascending[cut]) / 2;
    if (cut > 0 && rule == OtsuRule::Bins100) keep = values[i] >= ascending[cut - 1];
    if (cut > 0 && rule == OtsuRule::Covis) keep = scores[i] > ascending[cut - 1] / (bins - 1);
    if (keep) selected.push_back(row);
  }
  return selected;
}

Selection similarity_score(const CorrespondenceSet& matches, const SimilarityScoreOptions& options) {
  std::vector<double> scores;
  for (int i = 0; i < matches.size(); ++i) scores.push_back(1 - matches.feature_distance(i));
  return {rows_by_otsu(scores, options.otsu), scores};
}

Selection nearest_neighbor_ratio(const CorrespondenceSet& matches, const NearestNeighborRatioOptions& options) {
  Selection selection;
  for (int i = 0; i < matches.size(); ++i) {
    selection.scores.push_back(0);
    if (matches.second_feature_distance(i) <= 0) continue;
    const double ratio = matches.feature_distance(i) / matches.second_feature_distance(i);
    selection.scores.back() = 1 - ratio;
    if (options.ratio == RatioRule::Lowe ? ratio <= options.threshold : 1 - ratio >= options.threshold)
      selection.rows.push_back(i);
  }
  return selection;
}

}  // namespace corral::reference
