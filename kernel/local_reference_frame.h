// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace corral {

/// A local reference frame as a 3x3 matrix whose ROWS are the unit axes x, y, z (right-handed, y = z cross x): it maps a
/// global direction to local coordinates, and its transpose maps back.
using LocalReferenceFrame = Eigen::Matrix3d;
using LocalReferenceFrames = std::vector<LocalReferenceFrame>;

/// True if the matrix is orthonormal to 1e-4 in every entry and right-handed. A keypoint without a frame carries the
/// zero matrix, which is not valid; neither is anything with NaN in it.
bool is_valid_frame(const LocalReferenceFrame& frame);

}  // namespace corral
