// SPDX-License-Identifier: MIT
#include "grouping/columns/compatibility.h"

#include <algorithm>
#include <limits>

#include "grouping/columns/column_loops.h"

namespace corral {

std::vector<double> feature_ratios(const CorrespondenceSet& matches) {
  std::vector<double> ratios(static_cast<std::size_t>(matches.size()));
  divide_columns(matches.feature_distance.data(), matches.second_feature_distance.data(), ratios.size(), ratios.data());
  return ratios;
}

std::vector<double> ratio_scores(const std::vector<double>& ratios) {
  std::vector<double> scores(ratios.size());
  std::transform(ratios.begin(), ratios.end(), scores.begin(), [](double ratio) {
    return ratio == ratio ? std::max(1 - ratio, std::numeric_limits<double>::lowest()) : 0;
  });
  return scores;
}

Indices marked_rows(const std::vector<std::uint8_t>& marks) {
  Indices rows(marks.size());
  std::size_t count = 0;
  for (std::size_t row = 0; row < marks.size(); ++row) {  // without a branch, which could not be predicted
    rows[count] = static_cast<int>(row);
    count += marks[row];
  }
  rows.resize(count);
  return rows;
}

RigidTransform transform_from_frames(const CorrespondenceSet& matches, int row) {
  const auto i = static_cast<std::size_t>(row);
  RigidTransform target_from_source;
  target_from_source.rotation = matches.target_frames[i].transpose() * matches.source_frames[i];
  target_from_source.translation = matches.target_points.row(row).transpose() -
                                   target_from_source.rotation * matches.source_points.row(row).transpose();
  return target_from_source;
}

}  // namespace corral
