// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace corral::peers {

/// The nearest and second nearest target column of every source column, by L2.
struct FlannNearest {
  std::vector<std::size_t> first, second;            ///< per source column
  std::vector<float> first_squared, second_squared;  ///< squared distances
};

/// FLANN with exact answers on one thread, D x N and D x M. Building the index is part of the call. Throws
/// std::invalid_argument for fewer than two targets.
FlannNearest match_with_flann_linear(const Eigen::MatrixXf& source, const Eigen::MatrixXf& target);
/// The same from a single kd-tree with 15 points to a leaf and unlimited checks: what PCL's kd-tree is.
FlannNearest match_with_flann_tree(const Eigen::MatrixXf& source, const Eigen::MatrixXf& target);

}  // namespace corral::peers
