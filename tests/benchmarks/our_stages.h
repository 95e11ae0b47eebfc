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

inline Points normals(const Mesh& mesh) { return estimate_normals(mesh); }

inline Indices harris(const Mesh& mesh, double resolution, double radius_pr = 3) {
  return detect_harris(mesh.vertices, resolution, {radius_pr}).vertices;
}

/// The response of every vertex.
inline Eigen::VectorXd response(const Mesh& mesh, double radius) { return harris_response(mesh.vertices, radius); }

inline Descriptors shot(const Mesh& mesh, const Points& normals, const Indices& keypoints, double resolution,
                        const std::string& form = "additive") {
  return describe_shot(mesh.vertices, normals, keypoints, resolution, {15, 10, form});
}

inline FeatureMatches matching(const Descriptors& source, const Descriptors& target) {
  return match_features(source.features, target.features);
}

inline MatchedPair whole_match(const Mesh& source, const Mesh& target) {
  MatchSettings settings;
  settings.threads = 1;
  return match_pair(source, target, settings);
}

}  // namespace corral::ours
