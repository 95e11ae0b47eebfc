// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "kernel/surface/matching/nearest_features.h"

namespace corral::testing {

/// The squared distance of two columns as feature_distance.h defines it, without vectors.
double reference_distance(const Eigen::MatrixXd& source, Eigen::Index i, const Eigen::MatrixXd& target, Eigen::Index j);

/// The two nearest columns by looking at all; the lower column among equals.
NearestFeatures reference_nearest_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target);

}  // namespace corral::testing
