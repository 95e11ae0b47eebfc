// SPDX-License-Identifier: MIT
#pragma once

// Tables of matches for tests: typed in by hand, or made from a synthetic problem.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/error.h"
#include "kernel/rigid_transform.h"
#include "kernel/synthetic.h"

namespace corral::testing {

using Row3 = std::array<double, 3>;

inline Points points_of(const std::vector<Row3>& rows) {
  Points points(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis)) = rows[i][axis];
  return points;
}

inline Eigen::VectorXd column_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Points only; the resolution is 1.
inline CorrespondenceSet table_of_points(const std::vector<Row3>& source, const std::vector<Row3>& target) {
  CorrespondenceSet table;
  table.source_points = points_of(source);
  table.target_points = points_of(target);
  return table;
}

/// Points on a line: row i sits at x = source[i] and x = target[i].
inline CorrespondenceSet table_on_line(const std::vector<double>& source, const std::vector<double>& target) {
  CorrespondenceSet table;
  table.source_points = Points::Zero(static_cast<Eigen::Index>(source.size()), 3);
  table.target_points = Points::Zero(static_cast<Eigen::Index>(target.size()), 3);
  table.source_points.col(0) = column_of(source);
  table.target_points.col(0) = column_of(target);
  return table;
}

/// Feature distances only; all points lie at the origin.
inline CorrespondenceSet table_of_features(const std::vector<double>& nearest, const std::vector<double>& second = {}) {
  const std::vector<double> zeros(nearest.size(), 0.0);
  CorrespondenceSet table = table_on_line(zeros, zeros);
  table.feature_distance = column_of(nearest);
  table.second_feature_distance = column_of(second);
  return table;
}

/// The same frame on both sides of every row: each match proposes a pure translation.
inline void set_identity_frames(CorrespondenceSet& table) {
  table.source_frames.assign(static_cast<std::size_t>(table.size()), Eigen::Matrix3d::Identity());
  table.target_frames = table.source_frames;
}

/// Five rows in general position with every column filled; what each contract is checked on.
inline CorrespondenceSet full_table(int rows = 5) {
  SyntheticOptions options;
  options.matches = rows;
  return make_synthetic_problem(options).matches;
}

inline SyntheticProblem synthetic(int matches, double inlier_ratio, std::uint64_t seed) {
  SyntheticOptions options;
  options.matches = matches;
  options.inlier_ratio = inlier_ratio;
  options.seed = seed;
  return make_synthetic_problem(options);
}

/// What real tables hold and smooth random ones do not: keypoints without a frame, several matches at one keypoint
/// (also with one target), equal feature distances, ratios that sit on the limit, no second feature.
inline CorrespondenceSet made_harsh(CorrespondenceSet table) {
  for (int row = 0; row < table.size(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (row % 7 == 3) table.source_frames[i].setZero();
    if (row % 11 == 5) table.target_frames[i].setZero();
    if (row % 9 == 8) table.source_points.row(row) = table.source_points.row(row - 1);
    if (row % 27 == 26) table.target_points.row(row) = table.target_points.row(row - 1);
    table.feature_distance(row) = std::round(table.feature_distance(row) * 32) / 32;
    table.second_feature_distance(row) = std::round(table.second_feature_distance(row) * 32) / 32;
    if (row % 13 == 6) table.second_feature_distance(row) = 0;
  }
  return table;
}

inline CorrespondenceSet harsh_table(int matches, double inlier_ratio, std::uint64_t seed) {
  return made_harsh(synthetic(matches, inlier_ratio, seed).matches);
}

/// Low noise, four of five matches right.
inline SyntheticProblem easy_problem(std::uint64_t seed) {
  SyntheticOptions options;
  options.matches = 400;
  options.inlier_ratio = 0.8;
  options.noise_pr = 0.2;
  options.frame_noise_deg = 0.5;
  options.seed = seed;
  return make_synthetic_problem(options);
}

/// The text of the InvalidInput that a call throws; empty if it throws none.
template <class Call>
std::string refusal_of(Call&& call) {
  try {
    call();
  } catch (const InvalidInput& refusal) {
    return refusal.what();
  }
  return "";
}

}  // namespace corral::testing
