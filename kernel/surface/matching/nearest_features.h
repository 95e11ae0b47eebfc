// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "kernel/parallel.h"
#include "kernel/types.h"

namespace corral {

/// Throws InvalidInput unless all features are finite. `side`: source or target.
void require_finite_features(const Eigen::Ref<const Eigen::MatrixXd>& features, const std::string& side);

/// The two nearest target features of every source feature.
struct NearestFeatures {
  Indices nearest;                          ///< column of the target features, per source feature
  Eigen::VectorXd squared_distance;         ///< to it
  Eigen::VectorXd second_squared_distance;  ///< to the second nearest, 0 where there is only one target feature
};

/// Exact nearest neighbours by L2 (columns of D x N and D x M).
///
///   d(i, j) = (a_i - b_j)^2 summed in double in one order      nearest_i = argmin_j d(i, j), ties to the lower column
///
/// The second distance is the second smallest of the values: that of another column, and equal to the first on a tie.
/// Nothing is returned if either side is empty. Every machine and number of threads gives the same bits.
///
/// Method    Lower bounds first, then the few distances that they leave open: features are projected on the principal
///           directions of a sample, and the length of the rest is kept (partial distances with the norm of the rest).
///           All pairs are bounded by a matrix product of 24 floats per feature, about 1 % of them again by 64 floats,
///           and about ten per source feature are measured in double. Bounds allow for every rounding, so that no
///           distance is missed; where floats cannot hold the features, all are measured.
/// Cost      O(D (N + M)) for the projection, 24 N M multiplications of floats; O(N M D) where all features are alike
///           or overflow. 90 floats per target, and 80 M floats per thread.
/// Throws    InvalidInput for numbers that are not finite.
/// Plain form  tests/support/reference/matching.h
NearestFeatures find_two_nearest(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                                 const ParallelFor& parallel = one_by_one);

}  // namespace corral
