// SPDX-License-Identifier: MIT
#include "kernel/synthetic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr double kRadiansPerDegree = 3.141592653589793 / 180.0;

void check(const char* field, double value, bool accepted, const char* range) {
  if (!accepted) throw InvalidInput("make_synthetic_problem", field, value, range);
}

Eigen::Vector3d uniform_in_cube(RandomStream& random, double side) {
  const double x = random.uniform(-side / 2, side / 2);
  const double y = random.uniform(-side / 2, side / 2);
  const double z = random.uniform(-side / 2, side / 2);
  return {x, y, z};
}

/// `count` distinct rows out of `rows`, ascending (a partial Fisher-Yates shuffle).
Indices choose_rows(RandomStream& random, int rows, int count) {
  Indices all(static_cast<std::size_t>(rows));
  std::iota(all.begin(), all.end(), 0);
  for (int i = 0; i < count; ++i)
    std::swap(all[static_cast<std::size_t>(i)],
              all[static_cast<std::size_t>(i) + random.below(static_cast<std::uint64_t>(rows - i))]);
  all.resize(static_cast<std::size_t>(count));
  std::sort(all.begin(), all.end());
  return all;
}

void resize_columns(CorrespondenceSet& table, int rows) {
  const auto count = static_cast<std::size_t>(rows);
  table.source_points.resize(rows, 3);
  table.target_points.resize(rows, 3);
  table.source_frames.resize(count);
  table.target_frames.resize(count);
  table.source_keypoints.resize(count);
  table.target_keypoints.resize(count);
  table.feature_distance.resize(rows);
  table.second_feature_distance.resize(rows);
  table.source_centroid = Eigen::Vector3d::Zero();
}

}  // namespace

SyntheticProblem make_synthetic_problem(const SyntheticOptions& options) {
  check("matches", options.matches, options.matches >= 0, "at least 0");
  check("inlier_ratio", options.inlier_ratio, options.inlier_ratio >= 0 && options.inlier_ratio <= 1, "0 .. 1");
  check("noise_pr", options.noise_pr, options.noise_pr >= 0 && std::isfinite(options.noise_pr), "at least 0");
  check("extent_pr", options.extent_pr, options.extent_pr > 0 && std::isfinite(options.extent_pr), "above 0");
  check("frame_noise_deg", options.frame_noise_deg,
        options.frame_noise_deg >= 0 && std::isfinite(options.frame_noise_deg), "at least 0");
  check("resolution", options.resolution, options.resolution > 0 && std::isfinite(options.resolution), "above 0");

  RandomStream random(options.seed);
  const double pr = options.resolution;
  const double side = options.extent_pr * pr;

  SyntheticProblem problem;
  problem.truth.rotation = random.rotation();
  problem.truth.translation = side * random.direction();
  problem.inliers =
      choose_rows(random, options.matches, static_cast<int>(std::lround(options.inlier_ratio * options.matches)));

  CorrespondenceSet& table = problem.matches;
  table.resolution = pr;
  resize_columns(table, options.matches);
  auto next_inlier = problem.inliers.begin();
  for (int row = 0; row < options.matches; ++row) {
    const auto i = static_cast<std::size_t>(row);
    const Eigen::Vector3d source = uniform_in_cube(random, side);
    const Eigen::Matrix3d frame = random.rotation();
    const bool right = next_inlier != problem.inliers.end() && *next_inlier == row;
    Eigen::Vector3d target;
    if (right) {
      ++next_inlier;
      const double x = random.normal(), y = random.normal(), z = random.normal();
      target = problem.truth * source + options.noise_pr * pr * Eigen::Vector3d(x, y, z);
      const double angle = options.frame_noise_deg * kRadiansPerDegree;
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
      table.target_frames[i] = frame * problem.truth.rotation.transpose() * turn;
    } else {
      target = problem.truth * uniform_in_cube(random, side);
      table.target_frames[i] = random.rotation();
    }
    table.source_points.row(row) = source.transpose();
    table.target_points.row(row) = target.transpose();
    table.source_frames[i] = frame;
    table.source_keypoints[i] = row;
    table.target_keypoints[i] = row;
    const double nearest = right ? random.uniform(0.05, 0.45) : random.uniform(0.3, 0.7);
    table.feature_distance(row) = nearest;
    table.second_feature_distance(row) = nearest / (right ? random.uniform(0.4, 0.9) : random.uniform(0.7, 1.0));
  }
  return problem;
}

}  // namespace corral
