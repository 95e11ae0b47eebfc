// SPDX-License-Identifier: MIT
#include "kernel/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/error.h"
#include "kernel/evaluation.h"

namespace corral {
namespace {

bool is_inlier(const SyntheticProblem& problem, int row) {
  return std::binary_search(problem.inliers.begin(), problem.inliers.end(), row);
}

Eigen::Vector3d residual(const SyntheticProblem& problem, int row) {
  return problem.matches.target_points.row(row).transpose() -
         problem.truth * Eigen::Vector3d(problem.matches.source_points.row(row).transpose());
}

/// Angle in degrees by which the target frame is turned away from the moved source frame.
double frame_error_deg(const SyntheticProblem& problem, int row) {
  const auto i = static_cast<std::size_t>(row);
  const Eigen::Matrix3d expected = problem.matches.source_frames[i] * problem.truth.rotation.transpose();
  return rotation_error_deg({problem.matches.target_frames[i], {}}, {expected, {}});
}

TEST(SyntheticProblem, FillsEveryColumn) {
  for (const int count : {0, 1, 2, 7, 500}) {
    SyntheticOptions options;
    options.matches = count;
    const CorrespondenceSet matches = make_synthetic_problem(options).matches;
    EXPECT_NO_THROW(matches.validate());
    const auto rows = static_cast<std::size_t>(count);
    EXPECT_EQ(matches.size(), count);
    EXPECT_EQ(matches.source_frames.size(), rows);
    EXPECT_EQ(matches.target_frames.size(), rows);
    EXPECT_EQ(matches.source_keypoints.size(), rows);
    EXPECT_EQ(matches.target_keypoints.size(), rows);
    EXPECT_EQ(matches.feature_distance.size(), count);
    EXPECT_EQ(matches.second_feature_distance.size(), count);
    if (count > 0) {
      EXPECT_LE((matches.feature_distance - matches.second_feature_distance).maxCoeff(), 0);
      EXPECT_GE(matches.feature_distance.minCoeff(), 0);
    }
    EXPECT_TRUE(std::all_of(matches.source_frames.begin(), matches.source_frames.end(), is_valid_frame));
    EXPECT_TRUE(std::all_of(matches.target_frames.begin(), matches.target_frames.end(), is_valid_frame));
  }
}

TEST(SyntheticProblem, CountOfRightMatchesIsRounded) {
  SyntheticOptions options;
  for (const int count : {10, 33}) {
    options.matches = count;
    for (const double ratio : {0.0, 0.04, 0.06, 0.5, 0.77, 1.0}) {
      options.inlier_ratio = ratio;
      const Indices inliers = make_synthetic_problem(options).inliers;
      EXPECT_EQ(inliers.size(), static_cast<std::size_t>(std::lround(ratio * count))) << ratio;
      EXPECT_TRUE(std::is_sorted(inliers.begin(), inliers.end()));
      EXPECT_EQ(std::adjacent_find(inliers.begin(), inliers.end()), inliers.end());
    }
  }
}

TEST(SyntheticProblem, RightMatchesHaveTheirNoise) {
  SyntheticOptions options;
  options.matches = 20000;
  options.noise_pr = 0.7;
  options.resolution = 0.01;
  const SyntheticProblem problem = make_synthetic_problem(options);
  EXPECT_TRUE(is_rotation(problem.truth.rotation, 1e-13));
  EXPECT_EQ(problem.matches.resolution, 0.01);
  Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
  int wrong_but_near = 0;
  for (int row = 0; row < 20000; ++row) {
    const Eigen::Array3d unit = residual(problem, row).array() / 0.007;
    if (!is_inlier(problem, row)) {
      if (unit.matrix().norm() < 10) ++wrong_but_near;
      continue;
    }
    sum += unit;
    squares += unit.square();
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum(axis) / 10000, 0, 5 / std::sqrt(10000.0));
    EXPECT_NEAR(squares(axis) / 10000, 1, 5 * std::sqrt(2 / 10000.0));
  }
  // A ball of 7 pr in a cube of 200 pr: about 1.8 of 10000.
  EXPECT_LT(wrong_but_near, 12);
}

TEST(SyntheticProblem, WithoutNoiseTruthIsExact) {
  SyntheticOptions options;
  options.noise_pr = 0;
  options.frame_noise_deg = 0;
  const SyntheticProblem problem = make_synthetic_problem(options);
  for (const int row : problem.inliers) {
    EXPECT_LT(residual(problem, row).norm(), 1e-11);
    EXPECT_LT(frame_error_deg(problem, row), 1e-9);
  }
}

TEST(SyntheticProblem, PointsLieInTheCubeAndItsImage) {
  SyntheticOptions options;
  options.matches = 5000;
  options.noise_pr = 0;
  options.extent_pr = 50;
  options.resolution = 2;
  options.inlier_ratio = 0.3;
  const SyntheticProblem problem = make_synthetic_problem(options);
  const Points& source = problem.matches.source_points;
  const Points back = problem.truth.inverse().apply(problem.matches.target_points);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = source.col(axis).minCoeff(), high = source.col(axis).maxCoeff();
    EXPECT_LE(high - low, 100);
    EXPECT_GT(high - low, 99);
    // The targets fill the image of the same cube.
    EXPECT_NEAR(back.col(axis).minCoeff(), low, 1);
    EXPECT_NEAR(back.col(axis).maxCoeff(), high, 1);
  }
}

TEST(SyntheticProblem, FramesOfRightMatchesMoveAlong) {
  SyntheticOptions options;
  options.matches = 4000;
  options.frame_noise_deg = 5;
  const SyntheticProblem problem = make_synthetic_problem(options);
  int wrong_but_aligned = 0;
  for (int row = 0; row < 4000; ++row) {
    if (is_inlier(problem, row)) {
      EXPECT_NEAR(frame_error_deg(problem, row), 5, 1e-9);
    } else if (frame_error_deg(problem, row) < 10) {
      ++wrong_but_aligned;
    }
  }
  EXPECT_LT(wrong_but_aligned, 20);  // 0.06 % of all rotations
}

TEST(SyntheticProblem, FeaturesTellRightFromWrongOnAverage) {
  SyntheticOptions options;
  options.matches = 4000;
  const SyntheticProblem problem = make_synthetic_problem(options);
  double right = 0, wrong = 0, right_ratio = 0, wrong_ratio = 0;
  for (int row = 0; row < 4000; ++row) {
    const double distance = problem.matches.feature_distance(row);
    const double ratio = distance / problem.matches.second_feature_distance(row);
    (is_inlier(problem, row) ? right : wrong) += distance;
    (is_inlier(problem, row) ? right_ratio : wrong_ratio) += ratio;
  }
  EXPECT_LT(right, wrong);
  EXPECT_LT(right_ratio, wrong_ratio);
}

TEST(SyntheticProblem, RightMatchesAreSpreadOverTheRows) {
  SyntheticOptions options;
  options.matches = 4000;
  const Indices inliers = make_synthetic_problem(options).inliers;
  const auto in_first_half = std::lower_bound(inliers.begin(), inliers.end(), 2000) - inliers.begin();
  EXPECT_NEAR(static_cast<double>(in_first_half), 1000, 5 * std::sqrt(250.0));
}

TEST(SyntheticProblem, SameSeedSameBytes) {
  SyntheticOptions options;
  const SyntheticProblem a = make_synthetic_problem(options), b = make_synthetic_problem(options);
  options.seed = 2;
  const SyntheticProblem c = make_synthetic_problem(options);
  EXPECT_EQ(a.inliers, b.inliers);
  const auto same = [](const Points& x, const Points& y) {
    return std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
  };
  EXPECT_TRUE(same(a.matches.source_points, b.matches.source_points));
  EXPECT_TRUE(same(a.matches.target_points, b.matches.target_points));
  EXPECT_EQ(a.matches.source_frames, b.matches.source_frames);
  EXPECT_EQ(a.matches.target_frames, b.matches.target_frames);
  EXPECT_EQ(a.matches.feature_distance, b.matches.feature_distance);
  EXPECT_EQ(a.matches.second_feature_distance, b.matches.second_feature_distance);
  EXPECT_EQ(a.truth.rotation, b.truth.rotation);
  EXPECT_FALSE(same(a.matches.source_points, c.matches.source_points));
  EXPECT_NE(a.inliers, c.inliers);
}

TEST(SyntheticProblem, OptionsAreChecked) {
  const auto refuses = [](auto&& change) {
    SyntheticOptions options;
    change(options);
    EXPECT_THROW(make_synthetic_problem(options), InvalidInput);
  };
  refuses([](auto& options) { options.matches = -1; });
  for (const double bad : {-0.1, std::nan(""), HUGE_VAL}) {
    refuses([&](auto& options) { options.inlier_ratio = bad; });
    refuses([&](auto& options) { options.noise_pr = bad; });
    refuses([&](auto& options) { options.extent_pr = bad; });
    refuses([&](auto& options) { options.frame_noise_deg = bad; });
    refuses([&](auto& options) { options.resolution = bad; });
  }
  refuses([](auto& options) { options.inlier_ratio = 1.1; });
  refuses([](auto& options) { options.resolution = 0; });
}

}  // namespace
}  // namespace corral
