// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/approximate_matching.h"

#include <flann/flann.hpp>

namespace corral {

NearestFeatures find_two_nearest_with_flann(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  constexpr int kTrees = 4, kChecks = 256;
  require_finite_features(source, "source");
  require_finite_features(target, "target");
  const auto wanted = static_cast<std::size_t>(std::min<Eigen::Index>(2, target.cols()));
  const auto count = static_cast<std::size_t>(source.cols());
  // Columns here are FLANN's rows; it does not write to them.
  Eigen::MatrixXf queries = source.cast<float>(), features = target.cast<float>();
  const auto rows = [](Eigen::MatrixXf& columns) {
    return flann::Matrix<float>(columns.data(), static_cast<std::size_t>(columns.cols()),
                                static_cast<std::size_t>(columns.rows()));
  };
  flann::Index<flann::L2<float>> index(rows(features), flann::KDTreeIndexParams(kTrees));
  index.buildIndex();
  std::vector<std::size_t> found(count * wanted);
  std::vector<float> squares(count * wanted);
  flann::Matrix<std::size_t> found_rows(found.data(), count, wanted);
  flann::Matrix<float> square_rows(squares.data(), count, wanted);
  index.knnSearch(rows(queries), found_rows, square_rows, wanted, flann::SearchParams(kChecks));

  NearestFeatures nearest;
  nearest.nearest.resize(count);
  nearest.squared_distance.resize(source.cols());
  nearest.second_squared_distance.setZero(source.cols());
  for (std::size_t i = 0; i < count; ++i) {
    const auto query = static_cast<Eigen::Index>(i);
    std::vector<std::pair<double, int>> both;
    for (std::size_t j = i * wanted; j < (i + 1) * wanted; ++j)
      both.emplace_back((source.col(query) - target.col(static_cast<Eigen::Index>(found[j]))).squaredNorm(),
                        static_cast<int>(found[j]));
    std::sort(both.begin(), both.end());
    nearest.nearest[i] = both.front().second;
    nearest.squared_distance(query) = both.front().first;
    if (wanted == 2) nearest.second_squared_distance(query) = both.back().first;
  }
  return nearest;
}

}  // namespace corral
