// SPDX-License-Identifier: MIT
#include "apps/pair/match_features.h"

#include "kernel/error.h"

namespace corral {

CorrespondenceSet match_feature_points(const FeaturePoints& source, const FeaturePoints& target,
                                       const MatchingOptions& options, const ParallelFor& parallel) {
  if (source.features.rows() != target.features.rows())
    throw InvalidInput("match", "length of the target features", std::to_string(target.features.rows()),
                       "that of the source features, " + std::to_string(source.features.rows()));
  const FeatureMatches found = match_features(source.features, target.features, options, parallel);
  CorrespondenceSet matches;
  matches.source_points = source.points(found.source, Eigen::all);
  matches.target_points = target.points(found.nearest, Eigen::all);
  if (!source.vertices.empty() && !target.vertices.empty())
    for (std::size_t i = 0; i < found.source.size(); ++i) {
      matches.source_keypoints.push_back(source.vertices[std::size_t(found.source[i])]);
      matches.target_keypoints.push_back(target.vertices[std::size_t(found.nearest[i])]);
    }
  matches.feature_distance = found.distance;
  matches.second_feature_distance = found.second_distance;
  matches.validate();
  return matches;
}

}  // namespace corral
