// SPDX-License-Identifier: MIT
#include "tests/support/reference/matching.h"

#include <limits>

namespace corral::testing {

double reference_distance(const Eigen::MatrixXd& source, Eigen::Index i, const Eigen::MatrixXd& target,
                          Eigen::Index j) {
  double sums[16] = {};
  for (Eigen::Index row = 0; row < source.rows(); ++row) {
    const double difference = source(row, i) - target(row, j);
    sums[row % 16] += difference * difference;
  }
  for (int width = 8; width > 0; width /= 2)
    for (int lane = 0; lane < width; ++lane) sums[lane] += sums[lane + width];
  return sums[0];
}

NearestFeatures reference_nearest_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  NearestFeatures result;
  result.squared_distance.setConstant(source.cols(), kInfinity);
  result.second_squared_distance.setConstant(source.cols(), kInfinity);
  for (Eigen::Index i = 0; i < source.cols(); ++i) {
    int nearest = 0;
    double &first = result.squared_distance(i), &second = result.second_squared_distance(i);
    for (Eigen::Index j = 0; j < target.cols(); ++j) {
      const double value = reference_distance(source, i, target, j);
      if (value < first)
        second = first, first = value, nearest = static_cast<int>(j);
      else if (value < second)
        second = value;
    }
    if (target.cols() == 1) second = 0;
    result.nearest.push_back(nearest);
  }
  return result;
}

}  // namespace corral::testing
