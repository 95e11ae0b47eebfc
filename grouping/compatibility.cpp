// SPDX-License-Identifier: MIT
#include "grouping/compatibility.h"

#include <algorithm>
#include <limits>

namespace corral {

std::vector<double> ratio_scores(const CorrespondenceSet& matches) {
  std::vector<double> scores(static_cast<std::size_t>(matches.size()));
  for (int row = 0; row < matches.size(); ++row) {
    const double d1 = matches.feature_distance(row), d2 = matches.second_feature_distance(row);
    scores[static_cast<std::size_t>(row)] = d2 > 0 ? std::max(1 - d1 / d2, std::numeric_limits<double>::lowest()) : 0;
  }
  return scores;
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
