// SPDX-License-Identifier: MIT
#include "kernel/surface/feature_matching.h"

#include <utility>

#include "kernel/surface/nearest_features.h"

namespace corral {

FeatureMatches match_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                              const ParallelFor& parallel) {
  NearestFeatures found = find_two_nearest(source, target, parallel);
  return {std::move(found.nearest), found.squared_distance.cwiseSqrt(), found.second_squared_distance.cwiseSqrt()};
}

CorrespondenceSet make_correspondences(const Mesh& source, const Descriptors& source_descriptors, const Mesh& target,
                                       const Descriptors& target_descriptors, double resolution) {
  const FeatureMatches found = match_features(source_descriptors.features, target_descriptors.features);
  CorrespondenceSet matches;
  matches.resolution = resolution;
  matches.source_centroid = vertex_centroid(source);
  matches.feature_distance = found.distance;
  matches.second_feature_distance = found.second_distance;
  for (std::size_t i = 0; i < found.nearest.size(); ++i) {
    const auto j = static_cast<std::size_t>(found.nearest[i]);
    matches.source_keypoints.push_back(source_descriptors.vertices[i]);
    matches.target_keypoints.push_back(target_descriptors.vertices[j]);
    matches.source_frames.push_back(source_descriptors.frames[i]);
    matches.target_frames.push_back(target_descriptors.frames[j]);
  }
  matches.source_points = source.vertices(matches.source_keypoints, Eigen::all);
  matches.target_points = target.vertices(matches.target_keypoints, Eigen::all);
  return matches;
}

}  // namespace corral
