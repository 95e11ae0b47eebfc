// SPDX-License-Identifier: MIT
#include "kernel/surface/keep_described.h"

#include "kernel/error.h"

namespace corral {

void require_keypoints(const char* who, const Points& vertices, const Points& normals, const Indices& keypoints) {
  if (normals.rows() != vertices.rows())
    throw InvalidInput(who, "number of normals", std::to_string(normals.rows()),
                       "one per vertex, " + std::to_string(vertices.rows()));
  for (const int vertex : keypoints)
    if (vertex < 0 || vertex >= vertices.rows())
      throw InvalidInput(who, "keypoint", std::to_string(vertex),
                         "vertices 0 .. " + std::to_string(vertices.rows() - 1));
}

void keep_described(const Indices& keypoints, const std::vector<KeypointOutcome>& outcomes, Descriptors& descriptors) {
  const bool has_frames = !descriptors.frames.empty();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    descriptors.dropped_small_support += outcomes[i] == KeypointOutcome::SmallSupport;
    descriptors.dropped_no_frame += outcomes[i] == KeypointOutcome::NoFrame;
    descriptors.dropped_no_histogram += outcomes[i] == KeypointOutcome::NoHistogram;
    if (outcomes[i] != KeypointOutcome::Described) continue;
    descriptors.vertices.push_back(keypoints[i]);
    if (kept < i) {
      if (has_frames) descriptors.frames[kept] = descriptors.frames[i];
      descriptors.features.col(static_cast<Eigen::Index>(kept)) =
          descriptors.features.col(static_cast<Eigen::Index>(i));
    }
    ++kept;
  }
  if (has_frames) descriptors.frames.resize(kept);
  descriptors.features.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(kept));
}

}  // namespace corral
