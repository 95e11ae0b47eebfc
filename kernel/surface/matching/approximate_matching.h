// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/matching/nearest_features.h"

namespace corral {

/// As find_two_nearest, by FLANN's randomised kd-trees: approximate, and different from call to call. Distances to the
/// features found are those of find_two_nearest up to rounding.
NearestFeatures find_two_nearest_with_flann(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target);

}  // namespace corral
