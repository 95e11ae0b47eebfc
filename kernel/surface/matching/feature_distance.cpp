// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/feature_distance.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/surface/matching/feature_distance.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

HWY_INLINE double squared_distance(const double* a, const double* b, Eigen::Index rows) {
  Lanes even = Lanes::fill(0), odd = even;
  const auto add = [&](const double* x, const double* y) HWY_ATTR {
    const Lanes first = Lanes::load(x) - Lanes::load(y), second = Lanes::load(x + kLanes) - Lanes::load(y + kLanes);
    even = even + first * first;
    odd = odd + second * second;
  };
  Eigen::Index row = 0;
  for (; row + 2 * kLanes <= rows; row += 2 * kLanes) add(a + row, b + row);
  if (row < rows) {
    double rest[2][2 * kLanes] = {};
    std::copy(a + row, a + rows, rest[0]);
    std::copy(b + row, b + rows, rest[1]);
    add(rest[0], rest[1]);
  }
  return sum(even + odd);
}

HWY_INLINE void fetch(const OfferedColumns& columns, int i) {
  const double* const column = columns.first + columns.chosen[i] * columns.rows;
  for (Eigen::Index row = 0; row < columns.rows; row += kLanes) hwy::Prefetch(column + row);
}

HWY_FLATTEN void offer(const double* feature, const OfferedColumns& columns, TwoNearest& nearest) {
  for (int i = 0; i < columns.count; ++i) {
    const int column = columns.chosen[i];
    nearest.offer(column, squared_distance(feature, columns.first + column * columns.rows, columns.rows));
  }
}

HWY_FLATTEN void offer_scored(const double* feature, const OfferedColumns& columns, const float* scores,
                              const ScoreBound& bound, TwoNearest& nearest) {
  float least = std::numeric_limits<float>::lowest();
  for (int i = 0; i < columns.count; ++i) {
    if (i + columns.ahead < columns.count) fetch(columns, i + columns.ahead);
    if (scores[i] < least) continue;
    const int column = columns.chosen[i];
    const double before = nearest.second_squared;
    nearest.offer(column, squared_distance(feature, columns.first + column * columns.rows, columns.rows));
    if (nearest.second_squared < before) least = bound.least(nearest.second_squared);
  }
}

HWY_FLATTEN void offer_all(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, Eigen::Index first,
                           std::vector<TwoNearest>& nearest) {
  constexpr Eigen::Index kBlock = 64;
  const Eigen::Index rows = source.rows();
  for (Eigen::Index begin = 0; begin < target.cols(); begin += kBlock)
    for (std::size_t i = 0; i < nearest.size(); ++i)
      for (Eigen::Index column = begin; column < std::min(target.cols(), begin + kBlock); ++column)
        nearest[i].offer(static_cast<int>(column),
                         squared_distance(source.data() + (first + static_cast<Eigen::Index>(i)) * rows,
                                          target.data() + column * rows, rows));
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(offer);
HWY_EXPORT(offer_scored);
HWY_EXPORT(offer_all);

void offer(const double* feature, const OfferedColumns& columns, TwoNearest& nearest) {
  HWY_DYNAMIC_DISPATCH(offer)(feature, columns, nearest);
}

void offer_scored(const double* feature, const OfferedColumns& columns, const float* scores, const ScoreBound& bound,
                  TwoNearest& nearest) {
  HWY_DYNAMIC_DISPATCH(offer_scored)(feature, columns, scores, bound, nearest);
}

void offer_all(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, Eigen::Index first,
               std::vector<TwoNearest>& nearest) {
  HWY_DYNAMIC_DISPATCH(offer_all)(source, target, first, nearest);
}

}  // namespace corral
#endif
