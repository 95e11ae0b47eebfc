// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "kernel/local_reference_frame.h"
#include "kernel/types.h"

namespace corral {

/// Descriptors of those keypoints that have one.
struct Descriptors {
  Indices vertices;               ///< vertex of each column, in the order of the keypoints
  LocalReferenceFrames frames;    ///< frame of each column; empty where the descriptor has none
  Eigen::MatrixXd features;       ///< D x N, one column per keypoint
  int dropped_small_support = 0;  ///< keypoints with too few vertices around them
  int dropped_no_frame = 0;       ///< keypoints without a frame
  int dropped_no_histogram = 0;   ///< keypoints with an empty histogram
};

}  // namespace corral
