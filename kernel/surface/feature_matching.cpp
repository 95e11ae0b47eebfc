// SPDX-License-Identifier: MIT
#include "kernel/surface/feature_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corral {
namespace {

constexpr Eigen::Index kBlock = 256;  // source features per matrix product

struct TwoNearest {
  Eigen::Index first = -1;
  double squared = std::numeric_limits<double>::infinity();
  double second_squared = std::numeric_limits<double>::infinity();

  void offer(Eigen::Index column, double value) {
    if (value < squared)
      second_squared = squared, squared = value, first = column;
    else if (value < second_squared)
      second_squared = value;
  }
};

/// The second smallest of some values (the smallest if there is one only).
double second_smallest(const Eigen::VectorXd& values) {
  double first = std::numeric_limits<double>::infinity(), second = first;
  for (const double value : values) {
    if (value < first)
      second = first, first = value;
    else if (value < second)
      second = value;
  }
  return values.size() > 1 ? second : first;
}

}  // namespace

FeatureMatches match_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  FeatureMatches matches;
  if (source.cols() == 0 || target.cols() == 0) return matches;
  matches.nearest.resize(static_cast<std::size_t>(source.cols()));
  matches.distance.resize(source.cols());
  matches.second_distance.setZero(source.cols());

  const Eigen::VectorXd source_squares = source.colwise().squaredNorm(),
                        target_squares = target.colwise().squaredNorm();
  for (Eigen::Index begin = 0; begin < source.cols(); begin += kBlock) {
    const Eigen::Index width = std::min(kBlock, source.cols() - begin);
    const Eigen::MatrixXd products = target.transpose() * source.middleCols(begin, width);
    for (Eigen::Index i = 0; i < width; ++i) {
      const Eigen::Index query = begin + i;
      const Eigen::VectorXd approximate = target_squares.array() + source_squares(query) - 2 * products.col(i).array();
      // |a|^2 + |b|^2 - 2ab is off by at most a few D ulps of the squares; 1e-11 covers D = 1000 many times over.
      const double slack = 1e-11 * (source_squares(query) + target_squares.maxCoeff());
      const double bound = second_smallest(approximate) + slack;
      TwoNearest nearest;
      for (Eigen::Index column = 0; column < target.cols(); ++column)
        if (approximate(column) <= bound) nearest.offer(column, (source.col(query) - target.col(column)).squaredNorm());
      matches.nearest[static_cast<std::size_t>(query)] = static_cast<int>(nearest.first);
      matches.distance(query) = std::sqrt(nearest.squared);
      if (target.cols() > 1) matches.second_distance(query) = std::sqrt(nearest.second_squared);
    }
  }
  return matches;
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
