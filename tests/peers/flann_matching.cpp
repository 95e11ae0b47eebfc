// SPDX-License-Identifier: MIT
#include "tests/peers/flann_matching.h"

#include <flann/flann.hpp>

#include <stdexcept>

namespace corral::peers {
namespace {

FlannNearest search_exactly(const Eigen::MatrixXf& source, const Eigen::MatrixXf& target,
                            const flann::IndexParams& params) {
  if (target.cols() < 2) throw std::invalid_argument("FLANN is asked for two neighbours: at least two targets");
  // FLANN takes rows, which in a column-major matrix are our columns; it does not write to what it is given.
  const auto wrap = [](const Eigen::MatrixXf& columns) {
    return flann::Matrix<float>(const_cast<float*>(columns.data()), static_cast<std::size_t>(columns.cols()),
                                static_cast<std::size_t>(columns.rows()));
  };
  flann::Index<flann::L2<float>> index(wrap(target), params);
  index.buildIndex();
  const auto count = static_cast<std::size_t>(source.cols());
  std::vector<std::size_t> columns(2 * count);
  std::vector<float> squared(2 * count);
  flann::Matrix<std::size_t> columns_out(columns.data(), count, 2);
  flann::Matrix<float> squared_out(squared.data(), count, 2);
  flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0.0F, true);
  exact.cores = 1;
  index.knnSearch(wrap(source), columns_out, squared_out, 2, exact);

  FlannNearest found;
  for (std::size_t i = 0; i < count; ++i) {
    found.first.push_back(columns[2 * i]);
    found.second.push_back(columns[2 * i + 1]);
    found.first_squared.push_back(squared[2 * i]);
    found.second_squared.push_back(squared[2 * i + 1]);
  }
  return found;
}

}  // namespace

FlannNearest match_with_flann_linear(const Eigen::MatrixXf& source, const Eigen::MatrixXf& target) {
  return search_exactly(source, target, flann::LinearIndexParams());
}

FlannNearest match_with_flann_tree(const Eigen::MatrixXf& source, const Eigen::MatrixXf& target) {
  return search_exactly(source, target, flann::KDTreeSingleIndexParams(15));
}

}  // namespace corral::peers
