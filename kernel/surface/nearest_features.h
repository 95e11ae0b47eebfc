// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "kernel/parallel.h"
#include "kernel/types.h"

namespace corral {

struct NearestFeatures {
  Indices nearest;
  Eigen::VectorXd squared_distance, second_squared_distance;
};
NearestFeatures find_two_nearest(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                                 const ParallelFor& parallel = one_by_one);

}  // namespace corral
