// SPDX-License-Identifier: MIT
#include "grouping/columns/canonical_order.h"

#include <algorithm>
#include <numeric>

namespace corral {
namespace {

/// Negative, 0 or positive, as the first numbers that differ.
template <class Numbers>
int compare(const Numbers& a, const Numbers& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (a(i) != b(i)) return a(i) < b(i) ? -1 : 1;
  return 0;
}

int compare(const LocalReferenceFrames& frames, std::size_t a, std::size_t b) {
  return frames.empty() ? 0 : compare(frames[a].reshaped(), frames[b].reshaped());
}

bool comes_before(const CorrespondenceSet& matches, int a, int b) {
  int sign = compare(matches.source_points.row(a), matches.source_points.row(b));
  if (sign == 0) sign = compare(matches.target_points.row(a), matches.target_points.row(b));
  for (const Eigen::VectorXd* column : {&matches.feature_distance, &matches.second_feature_distance})
    if (sign == 0 && column->size() > 0) sign = compare(column->segment<1>(a), column->segment<1>(b));
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  if (sign == 0) sign = compare(matches.source_frames, i, j);
  if (sign == 0) sign = compare(matches.target_frames, i, j);
  return sign != 0 ? sign < 0 : a < b;
}

}  // namespace

Indices canonical_order(const CorrespondenceSet& matches) {
  Indices order(static_cast<std::size_t>(matches.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return comes_before(matches, a, b); });
  return order;
}

GroupingResult group_in_canonical_order(const CorrespondenceSet& matches, const GroupFunction& group) {
  const Indices order = canonical_order(matches);
  GroupingResult result = group(select_rows(matches, order));
  for (int& row : result.selected) row = order[static_cast<std::size_t>(row)];
  std::sort(result.selected.begin(), result.selected.end());
  std::vector<double> scores(result.scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) scores[static_cast<std::size_t>(order[i])] = result.scores[i];
  result.scores = std::move(scores);
  return result;
}

double canonical_order_memory(int matches) {
  return (sizeof(int) + 2 * sizeof(Eigen::Matrix3d) + 8 * sizeof(double) + 2 * sizeof(int)) * 1.0 * matches;
}

}  // namespace corral
