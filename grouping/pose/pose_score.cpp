// SPDX-License-Identifier: MIT
#include "grouping/pose/pose_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/pose/pose_score.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

template <class Number, class Load>
HWY_INLINE Number squared_residual(const RigidTransform& motion, const Load& load) {
  const Eigen::Matrix3d& r = motion.rotation;
  const Number x = load(0), y = load(1), z = load(2);
  const auto component = [&](int axis) {
    return load.fill(r(axis, 0)) * x + load.fill(r(axis, 1)) * y + load.fill(r(axis, 2)) * z +
           load.fill(motion.translation(axis)) - load(3 + axis);
  };
  const Number a = component(0), b = component(1), c = component(2);
  return a * a + b * b + c * c;
}

/// Source and target points from a row on, one lane or many.
struct OneRow {
  const CorrespondenceSet& matches;
  int row;
  double operator()(int column) const {
    return column < 3 ? matches.source_points(row, column) : matches.target_points(row, column - 3);
  }
  static double fill(double number) { return number; }
};
struct ManyRows {
  const CorrespondenceSet& matches;
  int row;
  HWY_INLINE Lanes operator()(int column) const {
    return Lanes::load(
        (column < 3 ? matches.source_points.col(column).data() : matches.target_points.col(column - 3).data()) + row);
  }
  static HWY_INLINE Lanes fill(double number) { return Lanes::fill(number); }
};

HWY_FLATTEN void measure_residuals(const CorrespondenceSet& matches, const RigidTransform& motion, double* residuals) {
  int row = 0;
  for (; row + kLanes <= matches.size(); row += kLanes)
    square_root(squared_residual<Lanes>(motion, ManyRows{matches, row})).store(residuals + row);
  for (; row < matches.size(); ++row)
    residuals[row] = std::sqrt(squared_residual<double>(motion, OneRow{matches, row}));
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(measure_residuals);

void measure_residuals(const CorrespondenceSet& matches, const RigidTransform& target_from_source,
                       std::vector<double>& residuals) {
  residuals.resize(static_cast<std::size_t>(matches.size()));
  HWY_DYNAMIC_DISPATCH(measure_residuals)(matches, target_from_source, residuals.data());
}

Indices rows_within(const std::vector<double>& residuals, double tolerance) {
  Indices rows;
  for (std::size_t row = 0; row < residuals.size(); ++row)
    if (residuals[row] < tolerance) rows.push_back(static_cast<int>(row));
  return rows;
}

PoseScorer::PoseScorer(const CorrespondenceSet& matches, PoseScore score, double tolerance)
    : score_(score), tolerance_(tolerance) {
  if (score != PoseScore::Oamae) return;
  const Points& q = matches.target_points;
  const auto point = [&](int row) { return std::make_tuple(q(row, 0), q(row, 1), q(row, 2)); };
  by_target_.resize(static_cast<std::size_t>(matches.size()));
  std::iota(by_target_.begin(), by_target_.end(), 0);
  std::stable_sort(by_target_.begin(), by_target_.end(), [&](int a, int b) { return point(a) < point(b); });
  starts_target_.assign(by_target_.size(), 1);
  for (std::size_t i = 1; i < by_target_.size(); ++i)
    starts_target_[i] = point(by_target_[i]) != point(by_target_[i - 1]);
}

double PoseScorer::operator()(const std::vector<double>& residuals) const {
  const auto total = [&](auto&& worth) {
    double sum = 0;
    for (const double residual : residuals)
      if (residual < tolerance_) sum += worth(residual / tolerance_);
    return sum;
  };
  switch (score_) {
    case PoseScore::Mae:
      return total([](double e) { return 1 - e; });
    case PoseScore::Mse:
      return total([](double e) { return (1 - e) * (1 - e); });
    case PoseScore::Msac:
      return total([](double e) { return 1 - e * e; });
    case PoseScore::Oamae:
      return one_per_target(residuals);
    default:
      return total([](double) { return 1.0; });
  }
}

double PoseScorer::one_per_target(const std::vector<double>& residuals) const {
  double total = 0, sum = 0;
  int rows = 0;
  const auto close = [&] {
    if (rows > 0) total += sum / rows;
    sum = rows = 0;
  };
  for (std::size_t i = 0; i < by_target_.size(); ++i) {
    if (starts_target_[i]) close();
    const double residual = residuals[static_cast<std::size_t>(by_target_[i])];
    if (!(residual < tolerance_)) continue;
    sum += 1 - residual / tolerance_;
    ++rows;
  }
  close();
  return total;
}

}  // namespace corral
#endif
