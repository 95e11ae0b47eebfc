// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/surface/descriptors.h"

namespace corral {

/// What became of a keypoint that was to be described.
enum class KeypointOutcome : char { Described, SmallSupport, NoFrame, NoHistogram };

/// Throws InvalidInput unless there is one normal per vertex and every keypoint is a vertex.
void require_keypoints(const char* who, const Points& vertices, const Points& normals, const Indices& keypoints);

/// From a column, and a frame if there are frames, for each keypoint to those of the described ones; counts the others.
void keep_described(const Indices& keypoints, const std::vector<KeypointOutcome>& outcomes, Descriptors& descriptors);

}  // namespace corral
