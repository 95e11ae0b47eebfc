// SPDX-License-Identifier: MIT
#include "kernel/surface/feature_matching.h"

#include <numeric>

#include "kernel/error.h"
#include "kernel/surface/matching/approximate_matching.h"
#include "kernel/surface/matching/nearest_features.h"

namespace corral {
namespace {

NearestFeatures find(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, const MatchingOptions& options,
                     const ParallelFor& parallel) {
  return options.matcher == Matcher::Flann ? find_two_nearest_with_flann(source, target)
                                           : find_two_nearest(source, target, parallel);
}

}  // namespace

FeatureMatches match_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                              const MatchingOptions& options, const ParallelFor& parallel) {
  FeatureMatches matches;
  if (source.cols() == 0 || target.cols() == 0) return matches;
  const NearestFeatures found = find(source, target, options, parallel);
  matches.source.resize(found.nearest.size());
  std::iota(matches.source.begin(), matches.source.end(), 0);
  if (options.mutual) {
    const NearestFeatures back = find(target, source, options, parallel);
    const auto is_one_sided = [&](int row) {
      return back.nearest[static_cast<std::size_t>(found.nearest[static_cast<std::size_t>(row)])] != row;
    };
    matches.source.erase(std::remove_if(matches.source.begin(), matches.source.end(), is_one_sided),
                         matches.source.end());
  }
  for (const int row : matches.source) matches.nearest.push_back(found.nearest[static_cast<std::size_t>(row)]);
  matches.distance = found.squared_distance(matches.source).cwiseSqrt();
  matches.second_distance = found.second_squared_distance(matches.source).cwiseSqrt();
  return matches;
}

CorrespondenceSet make_correspondences(const DescribedSurface& source, const DescribedSurface& target,
                                       double resolution, const MatchingOptions& options, const ParallelFor& parallel) {
  const FeatureMatches found =
      match_features(source.descriptors.features, target.descriptors.features, options, parallel);
  const bool has_frames = !source.descriptors.frames.empty() && !target.descriptors.frames.empty();
  CorrespondenceSet matches;
  matches.resolution = resolution;
  matches.source_centroid = vertex_centroid(source.mesh);
  matches.feature_distance = found.distance;
  matches.second_feature_distance = found.second_distance;
  for (std::size_t row = 0; row < found.source.size(); ++row) {
    const auto i = static_cast<std::size_t>(found.source[row]), j = static_cast<std::size_t>(found.nearest[row]);
    matches.source_keypoints.push_back(source.descriptors.vertices[i]);
    matches.target_keypoints.push_back(target.descriptors.vertices[j]);
    if (!has_frames) continue;
    matches.source_frames.push_back(source.descriptors.frames[i]);
    matches.target_frames.push_back(target.descriptors.frames[j]);
  }
  matches.source_points = source.mesh.vertices(matches.source_keypoints, Eigen::all);
  matches.target_points = target.mesh.vertices(matches.target_keypoints, Eigen::all);
  return matches;
}

}  // namespace corral
