// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/surface/mesh.h"

namespace corral {

/// How one pair of surfaces becomes a table of matches. Defaults: the paper's.
struct MatchSettings {
  std::string resolution = "mean";  ///< pr of the pair: mean|source|target of the two, or a length in mesh units
  double keypoint_radius_pr = 3;
  double support_radius_pr = 15;
};

/// What happened to one of the two surfaces.
struct SurfaceReport {
  int points = 0, faces = 0;
  double resolution = 0;  ///< its own, mesh units per pr
  int candidates = 0;
  int dropped_small_support = 0, dropped_no_frame = 0, dropped_no_histogram = 0;
  int keypoints = 0;  ///< described ones: candidates less those dropped
  double resolution_ms = 0, normals_ms = 0, keypoints_ms = 0, descriptors_ms = 0;
};

struct MatchReport {
  SurfaceReport source, target;
  double resolution = 0;                           ///< of the pair
  double keypoint_radius = 0, support_radius = 0;  ///< mesh units
  int matches = 0;
  double matching_ms = 0;
  std::vector<std::string> hints;  ///< what to do about a count that is zero
};

struct MatchedPair {
  CorrespondenceSet matches;
  MatchReport report;
};

/// Called with what begins; may be empty.
using StageObserver = std::function<void(const std::string& stage)>;
constexpr int kMatchStages = 9;

/// resolution -> keypoints -> normals, frames and descriptors of both surfaces -> matches. Throws InvalidInput.
MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings,
                       const StageObserver& observer = {});

/// The text of `resolution` is mean, source, target or a positive length. Throws InvalidInput if it is not.
void check_resolution_rule(const std::string& rule);

}  // namespace corral
