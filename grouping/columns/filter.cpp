// SPDX-License-Identifier: MIT
#include "grouping/columns/filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/bounding_box.h"

namespace corral {
namespace {

constexpr double kUnitRoundoff = 0x1p-24;
constexpr double kSlack = 16 * kUnitRoundoff;  // for the few roundings of a test and of its constants
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// The largest coordinate of a point, seen from the middle of their box: rounding keeps the order of differences.
double reach(const BoundingBox& box) {
  return (box.low - box.middle()).cwiseAbs().cwiseMax((box.high - box.middle()).cwiseAbs()).maxCoeff();
}

std::array<FloatColumn, 3> rounded(const Points& points, const Eigen::Vector3d& origin, double scale) {
  std::array<FloatColumn, 3> columns;
  for (int axis = 0; axis < 3; ++axis) {
    FloatColumn& column = columns[static_cast<std::size_t>(axis)];
    column.assign(static_cast<std::size_t>(padded(static_cast<int>(points.rows()), kFloatLanes)), kNothing);
    Eigen::Map<Eigen::VectorXf>(column.data(), points.rows()) =
        ((points.col(axis).array() - origin(axis)) * scale).cast<float>();
  }
  return columns;
}

}  // namespace

FilterTable::FilterTable(const CorrespondenceSet& matches) : rows_(matches.size()) {
  const BoundingBox source = bounding_box(matches.source_points), target = bounding_box(matches.target_points);
  source_origin_ = source.middle().transpose(), target_origin_ = target.middle().transpose();
  const double extent = std::max(reach(source), reach(target));
  // Squares of doubles neither vanish nor overflow in this range: the double distances are what they should be.
  is_blind_ = !(extent > 0x1p-400 && extent < 0x1p400);
  int exponent = 0;
  std::frexp(extent, &exponent);
  if (!is_blind_) unit_ = std::ldexp(1.0, exponent);
  const double scale = is_blind_ ? 0 : 1 / unit_;
  source_ = rounded(matches.source_points, source_origin_, scale);
  target_ = rounded(matches.target_points, target_origin_, scale);
}

FilterTable FilterTable::subset(const Indices& rows) const {
  FilterTable some = *this;
  some.rows_ = static_cast<int>(rows.size());
  const auto choose = [&](std::array<FloatColumn, 3>& columns) {
    for (FloatColumn& column : columns) {
      FloatColumn chosen(static_cast<std::size_t>(some.padded_rows()), kNothing);
      for (std::size_t i = 0; i < rows.size(); ++i) chosen[i] = column[static_cast<std::size_t>(rows[i])];
      column = std::move(chosen);
    }
  };
  choose(some.source_);
  choose(some.target_);
  return some;
}

float FilterTable::hide(int row) { return std::exchange(source_[0][static_cast<std::size_t>(row)], kNothing); }

ConsistencyFilter::ConsistencyFilter(const FilterTable& table, double tolerance) {
  const double farthest = 4;  // no distance in the table reaches it: a larger tolerance has the same effect
  const double t = std::min(tolerance / table.unit(), farthest) * (1 + kSlack) + 2 * kFilterDistanceError;
  const auto scale = static_cast<float>(0.5 / t);
  const auto end = static_cast<std::size_t>(padded(table.rows(), kGroup));
  double farthest_square = 0;
  const auto scaled = [&](std::array<FloatColumn, 3>& columns, FloatColumn& squares, auto from) {
    using Array = Eigen::Map<Eigen::ArrayXf>;
    squares.assign(end, kNothing);
    Array sum(squares.data(), table.rows());
    sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      FloatColumn& column = columns[static_cast<std::size_t>(axis)];
      column.assign(end, kNothing);
      Array places(column.data(), table.rows());
      places = Eigen::Map<const Eigen::ArrayXf>(from(axis), table.rows()) * scale;
      sum += places.square();
    }
    if (table.rows() > 0) farthest_square = std::max(farthest_square, static_cast<double>(sum.maxCoeff()));
  };
  scaled(source_, source_square_, [&](int axis) { return table.source(axis); });
  scaled(target_, target_square_, [&](int axis) { return table.target(axis); });
  const double error = 96 * kUnitRoundoff * (farthest_square + 1);
  const double surplus = 0.0625 + (error * (4 * std::sqrt(farthest_square) + 3) + error * error) * (1 + kSlack);
  rows_.resize(end);
  for (std::size_t i = 0; i < end; ++i) {
    Row& row = rows_[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      row.source[axis] = -2 * source_[axis][i], row.target[axis] = -2 * target_[axis][i];
    row.offset = target_square_[i] - source_square_[i] - 0.25f;
    row.surplus = source_square_[i] + static_cast<float>(surplus);
  }
}

SimilarityFilter::SimilarityFilter(double similarity) {
  constexpr double h = 0x1p-17;  // balances the two terms at distances of about the extent
  const double s2 = similarity * similarity, c = kFilterDistanceError * (1 + similarity);
  certain_slope = static_cast<float>(s2 * (1 + h) * (1 + kSlack));
  possible_slope = static_cast<float>(s2 / (1 + h) * (1 - kSlack));
  offset = static_cast<float>(c * c * (1 + 1 / h) * (1 + kSlack));
}

PoseFilter::PoseFilter(const FilterTable& table, const RigidTransform& target_from_source, double tolerance) {
  const Eigen::Matrix3d& r = target_from_source.rotation;
  const Eigen::Vector3d& t = target_from_source.translation;
  const Eigen::Vector3d moved = (r * table.source_origin() + t - table.target_origin()) / table.unit();
  // Of each component of the residual: the roundings of the points, of the pose, and of nine operations on numbers of at
  // most sqrt(3) + 1 and the translation; of its square, three more. Then what doubles lose far from their origin.
  const double far = table.source_origin().lpNorm<1>() + table.target_origin().lpNorm<1>() + t.lpNorm<1>();
  const double error = kUnitRoundoff * (64 + 16 * moved.norm()) + 0x1p-48 * (far / table.unit() + 4);
  const double limit = std::min(tolerance / table.unit(), 0x1p40);
  const bool blind = table.is_blind() || !(error < 0x1p10);
  for (int i = 0; i < 9; ++i) rotation[i] = blind ? 0 : static_cast<float>(r(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) translation[i] = blind ? 0 : static_cast<float>(moved(i));
  const double far_limit = blind ? 0x1p40 : limit + error, near_limit = blind ? 0 : limit - error;
  reach = static_cast<float>(far_limit * (1 + kSlack));
  possible = static_cast<float>(far_limit * far_limit * (1 + kSlack));
  certain = near_limit > 0 ? static_cast<float>(near_limit * near_limit * (1 - kSlack)) : 0;
}

}  // namespace corral
