// SPDX-License-Identifier: MIT
#pragma once

// Every call that is compared with another library, in one place. Each does what a program would: it builds what it
// searches in. The options are the paper's.

#include "apps/match_pair.h"
#include "kernel/surface/descriptor.h"
#include "kernel/surface/feature_matching.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/resolution.h"

namespace corral::ours {

inline double resolution(const Mesh& mesh) { return point_resolution(mesh.vertices); }

inline Points normals(const Mesh& mesh) { return estimate_normals(mesh, PointIndex(mesh.vertices)); }

inline Indices harris(const Mesh& mesh, double resolution, double radius_pr = 3) {
  return detect_harris(mesh, PointIndex(mesh.vertices), resolution, {radius_pr, 15, 10}).vertices;
}

/// The response of every vertex.
inline Eigen::VectorXd response(const Mesh& mesh, double radius) {
  const PointIndex index(mesh.vertices);
  std::vector<std::vector<Neighbor>> neighborhoods;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    neighborhoods.push_back(index.within(mesh.vertices.row(row).transpose(), radius));
  return harris_response(mesh.vertices, neighborhoods);
}

inline Descriptors shot(const Mesh& mesh, const Points& normals, const Indices& keypoints, double resolution) {
  return describe_shot(mesh, normals, PointIndex(mesh.vertices), keypoints, resolution);
}

inline FeatureMatches matching(const Descriptors& source, const Descriptors& target) {
  return match_features(source.features, target.features);
}

inline MatchedPair whole_match(const Mesh& source, const Mesh& target) { return match_pair(source, target, {}); }

}  // namespace corral::ours
