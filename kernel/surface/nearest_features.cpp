// SPDX-License-Identifier: MIT
#include "kernel/surface/nearest_features.h"
#include <limits>
namespace corral {
NearestFeatures find_two_nearest(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, const ParallelFor&) {
  NearestFeatures n;
  n.nearest.resize(static_cast<std::size_t>(source.cols()));
  n.squared_distance.resize(source.cols());
  n.second_squared_distance.setZero(source.cols());
  for (Eigen::Index i = 0; i < source.cols(); ++i) {
    double a = std::numeric_limits<double>::infinity(), b = a;
    int k = 0;
    for (Eigen::Index j = 0; j < target.cols(); ++j) {
      double d = (source.col(i) - target.col(j)).squaredNorm();
      if (d < a)
        b = a, a = d, k = static_cast<int>(j);
      else if (d < b)
        b = d;
    }
    n.nearest[static_cast<std::size_t>(i)] = k;
    n.squared_distance(i) = a;
    if (target.cols() > 1) n.second_squared_distance(i) = b;
  }
  return n;
}
}  // namespace corral
