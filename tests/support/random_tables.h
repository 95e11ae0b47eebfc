// SPDX-License-Identifier: MIT
#pragma once

// Small tables of any kind, each a pure function of its number.

#include <cmath>
#include <string>

#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral::testing {

/// 5 to 60 rows, few more often than many, and five times as many in one of fifty; any share of right matches, any
/// crowding; one in three is harsh.
inline CorrespondenceSet random_table(RandomStream& random) {
  SyntheticOptions options;
  options.matches = static_cast<int>(std::lround(5 * std::pow(12, random.uniform())));
  if (random.below(50) == 0) options.matches *= 5;
  options.inlier_ratio = random.uniform();
  options.noise_pr = random.uniform();
  options.extent_pr = random.uniform(20, 200);
  options.frame_noise_deg = random.uniform(0, 5);
  options.resolution = random.uniform(0.1, 10);
  options.seed = random.below(1u << 31);
  const CorrespondenceSet table = make_synthetic_problem(options).matches;
  return random.below(3) == 0 ? made_harsh(table) : table;
}

/// Whole numbers on one line, half turns, and ratios in steps of 0.05: differences, ratios and residuals sit on the limits
/// 3, 0.6, 0.8, 0.9 and 5 time and again. In every other table they lie beside them by what a double can tell but a float
/// cannot.
inline CorrespondenceSet table_on_the_limits(RandomStream& random) {
  CorrespondenceSet table = random_table(random);
  const auto whole = [&](int count) { return static_cast<double>(random.below(static_cast<std::uint64_t>(count))); };
  table.source_points.setZero();
  table.target_points.setZero();
  table.resolution = 1;
  const double width = 10 + whole(50);
  const double nudge = random.below(2) == 0 ? 0 : 1;
  const auto nudged = [&](double value, double step) { return value * (1 + nudge * step * (whole(5) - 2)); };
  constexpr double kLengthStep = 0x1p-40, kFeatureStep = 0x1p-30;  // far from the ties of ST (1e-9) and Otsu (1e-12)
  for (int row = 0; row < table.size(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    const double place = whole(static_cast<int>(width));
    const double image = random.below(2) == 0 ? place + whole(6) : whole(static_cast<int>(width));
    table.source_points(row, 0) = nudged(place, kLengthStep);
    table.target_points(row, 0) = nudged(image, kLengthStep);
    table.source_frames[i].setIdentity();
    table.target_frames[i] = Eigen::Vector3d(random.below(4) == 0 ? -1 : 1, 1, 1).asDiagonal();
    table.target_frames[i](1, 1) = table.target_frames[i](0, 0);
    table.second_feature_distance(row) = 1 + whole(4);
    table.feature_distance(row) = nudged(table.second_feature_distance(row) * whole(21) / 20, kFeatureStep);
  }
  return table;
}

/// The stream of case `number`: first its table, then what is done to it.
inline RandomStream stream_of_case(int number) { return RandomStream(derive_seed(number, "case")); }

}  // namespace corral::testing
