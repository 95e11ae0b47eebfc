// SPDX-License-Identifier: MIT
#include "refine/refine_rigid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "tests/refine/refine_problems.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::all_rows;
using testing::problem;

RefinedPose refine(const CorrespondenceSet& matches, const RefineOptions& options = {}) {
  return refine_rigid(matches, all_rows(matches), options);
}

/// |A - B| over sqrt 2: the angle between two rotations that are close.
double small_angle(const RigidTransform& a, const RigidTransform& b) {
  return (a.rotation - b.rotation).norm() / std::sqrt(2.0);
}

Eigen::Vector3d residual(const CorrespondenceSet& matches, const RigidTransform& pose, int row) {
  return pose * Eigen::Vector3d(matches.source_points.row(row).transpose()) -
         matches.target_points.row(row).transpose();
}

double robust_cost(const CorrespondenceSet& matches, const Indices& rows, const RigidTransform& pose, double scale_pr) {
  double cost = 0;
  for (const int row : rows) {
    const double squared = residual(matches, pose, row).squaredNorm() / (matches.resolution * matches.resolution);
    cost += scale_pr * scale_pr * std::log1p(squared / (scale_pr * scale_pr));
  }
  return cost;
}

double rms_pr(const CorrespondenceSet& matches, const Indices& rows, const RigidTransform& pose) {
  double sum = 0;
  for (const int row : rows) sum += residual(matches, pose, row).squaredNorm();
  return std::sqrt(sum / static_cast<double>(rows.size())) / matches.resolution;
}

/// s^2 (sum w J^T J)^-1 as the header says it, for the usual loss: rho'' = -w^2 / a^2.
PoseCovariance covariance_by_formula(const CorrespondenceSet& matches, const RigidTransform& pose, double scale_pr) {
  PoseCovariance information = PoseCovariance::Zero();
  const double count = matches.size();
  double pulls = 0, weights = 0, slopes = 0, slope_squares = 0;
  for (int row = 0; row < matches.size(); ++row) {
    const Eigen::Vector3d error = residual(matches, pose, row);
    const double relative = error.squaredNorm() / std::pow(scale_pr * matches.resolution, 2);
    const double weight = 1 / (1 + relative), slope = weight - 2.0 / 3 * relative * weight * weight;
    const Eigen::Vector3d arm = pose.rotation * matches.source_points.row(row).transpose();
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0, 0, 1;
    information += weight * jacobian.transpose() * jacobian;
    pulls += weight * weight * error.squaredNorm();
    weights += weight;
    slopes += slope;
    slope_squares += slope * slope;
  }
  const double mean = slopes / count, variance = slope_squares / count - mean * mean;
  const double k = 1 + 6 / (3 * count) * variance / (mean * mean);
  return k * k * pulls / (3 * count - 6) * (weights / count) / (mean * mean) * information.inverse();
}

/// No pose for that reason, and nothing that would need one.
void expect_no_pose(const RefinedPose& found, RefineStatus status) {
  EXPECT_EQ(found.status, status) << to_text(found.status);
  EXPECT_FALSE(found.target_from_source.has_value());
  EXPECT_FALSE(found.covariance.has_value());
  EXPECT_FALSE(found.converged);
}

TEST(RefineRigid, TruthIsRecoveredWithoutNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticProblem given = problem(seed % 2 == 0 ? 3 : 50, 1, 0, seed);
    const RefinedPose found = refine(given.matches);
    ASSERT_EQ(found.status, RefineStatus::Refined);
    EXPECT_TRUE(found.converged);
    EXPECT_LT(small_angle(*found.target_from_source, given.truth), 1e-9);
    EXPECT_LT((found.target_from_source->translation - given.truth.translation).norm(), 1e-9 * 200);
    EXPECT_TRUE(is_rotation(found.target_from_source->rotation, 1e-12));
    ASSERT_TRUE(found.covariance.has_value());
    EXPECT_TRUE(found.covariance->allFinite());
    EXPECT_LT(found.final_rms_pr, 1e-9);
  }
}

TEST(RefineRigid, TruthIsRecoveredAmongGrossErrors) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticProblem given = problem(200, 0.7, 0.5, seed);
    const RefinedPose found = refine(given.matches);
    ASSERT_EQ(found.status, RefineStatus::Refined);
    // 140 correct matches over a cube of 200 pr: deviations of about 5e-4 rad, and 0.04 pr at the middle.
    EXPECT_LT(small_angle(*found.target_from_source, given.truth), 0.003) << seed;
    const Eigen::Vector3d middle = given.matches.source_points.colwise().mean().transpose();
    EXPECT_LT((*found.target_from_source * middle - given.truth * middle).norm(), 0.3) << seed;
    EXPECT_GT(small_angle(*found.initial, given.truth), small_angle(*found.target_from_source, given.truth));
  }
}

TEST(RefineRigid, CostNeverRises) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed)
    for (const double scale_pr : {0.5, 5.0, 500.0}) {
      const CorrespondenceSet matches = problem(40, 0.1 * static_cast<double>(seed % 11), 1, seed, 0.01).matches;
      RefineOptions options;
      options.loss_scale_pr = scale_pr;
      options.maximum_iterations = seed % 3 == 0 ? 2 : 100;
      const RefinedPose found = refine(matches, options);
      ASSERT_EQ(found.status, RefineStatus::Refined);
      ASSERT_TRUE(found.initial.has_value());
      const double before = robust_cost(matches, all_rows(matches), *found.initial, scale_pr);
      EXPECT_LE(robust_cost(matches, all_rows(matches), *found.target_from_source, scale_pr), before * (1 + 1e-12));
      EXPECT_NEAR(found.initial_cost, before, 1e-9 * before);
      EXPECT_LE(found.final_cost, found.initial_cost);
      EXPECT_LE(found.iterations, options.maximum_iterations);
      EXPECT_NEAR(found.initial_rms_pr, rms_pr(matches, all_rows(matches), *found.initial), 1e-9);
      EXPECT_NEAR(found.final_rms_pr, rms_pr(matches, all_rows(matches), *found.target_from_source), 1e-9);
    }
}

TEST(RefineRigid, EndsInAMinimum) {
  const SyntheticProblem given = problem(80, 0.8, 0.5, 3);
  const Indices rows = all_rows(given.matches);
  const RefinedPose found = refine(given.matches);
  ASSERT_TRUE(found.converged);
  const double lowest = robust_cost(given.matches, rows, *found.target_from_source, 5);
  RandomStream random(4);
  for (int trial = 0; trial < 100; ++trial) {
    RigidTransform aside = *found.target_from_source;
    aside.rotation = Eigen::AngleAxisd(1e-3, random.direction()).toRotationMatrix() * aside.rotation;
    aside.translation += 0.1 * random.direction();
    EXPECT_GT(robust_cost(given.matches, rows, aside, 5), lowest);
  }
}

TEST(RefineRigid, StartsFromTheLeastSquaresFitOfTheRows) {
  const SyntheticProblem given = problem(60, 0.5, 0.5, 5);
  const RefinedPose found = refine_rigid(given.matches, given.inliers);
  const auto initial = fit_rigid_transform(given.matches, given.inliers);
  EXPECT_LT(small_angle(*found.initial, *initial), 1e-12);
  EXPECT_LT((found.initial->translation - initial->translation).norm(), 1e-10);
  EXPECT_LT(small_angle(*found.target_from_source, given.truth), 0.005);
  // A wide loss is least squares.
  RefineOptions wide;
  wide.loss_scale_pr = 1e6;
  EXPECT_LT(small_angle(*refine_rigid(given.matches, given.inliers, wide).target_from_source, *initial), 1e-7);
}

TEST(RefineRigid, CovarianceFollowsItsFormula) {
  for (const double resolution : {1.0, 0.01})
    for (const double ratio : {1.0, 0.8}) {
      const CorrespondenceSet matches = problem(60, ratio, 0.5, 6, resolution).matches;
      const RefinedPose found = refine(matches);
      const PoseCovariance expected = covariance_by_formula(matches, *found.target_from_source, 5);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
          const double unit = std::sqrt(expected(i, i) * expected(j, j));
          EXPECT_NEAR((*found.covariance)(i, j), expected(i, j), 1e-7 * unit);
          EXPECT_NEAR((*found.covariance)(i, j), (*found.covariance)(j, i), 1e-12 * unit);
        }
    }
}

TEST(RefineRigid, UnitOfLengthDoesNotMatter) {
  for (const double factor : {1024.0, 1.0 / 1024}) {
    const CorrespondenceSet matches = problem(150, 0.7, 0.5, 9).matches;
    const RefinedPose found = refine(matches), resized = refine(testing::scaled(matches, factor));
    ASSERT_EQ(resized.status, RefineStatus::Refined);
    EXPECT_LT(small_angle(*found.target_from_source, *resized.target_from_source), 1e-9);
    EXPECT_LT((resized.target_from_source->translation / factor - found.target_from_source->translation).norm(), 1e-6);
    EXPECT_NEAR(resized.final_rms_pr, found.final_rms_pr, 1e-6);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double unit = (i < 3 ? 1 : factor) * (j < 3 ? 1 : factor);
        EXPECT_NEAR((*resized.covariance)(i, j) / unit, (*found.covariance)(i, j),
                    1e-6 * std::sqrt((*found.covariance)(i, i) * (*found.covariance)(j, j)));
      }
  }
}

TEST(RefineRigid, FarFromTheOrigin) {
  SyntheticProblem given = problem(100, 0.8, 0.5, 10);
  const RefinedPose near = refine(given.matches);
  for (const double offset : {1e4, 1e6}) {
    CorrespondenceSet far = given.matches;
    far.source_points.array() += offset;
    far.target_points.array() += offset;
    const RefinedPose found = refine(far);
    ASSERT_EQ(found.status, RefineStatus::Refined);
    EXPECT_LT(small_angle(*found.target_from_source, *near.target_from_source), 1e-7) << offset;
    EXPECT_NEAR(found.final_rms_pr, near.final_rms_pr, 1e-5) << offset;
  }
}

TEST(RefineRigid, TooFewRows) {
  const CorrespondenceSet matches = problem(10, 1, 0, 11).matches;
  for (const Indices& rows : {Indices{}, Indices{4}, Indices{4, 7}}) {
    const RefinedPose found = refine_rigid(matches, rows);
    expect_no_pose(found, RefineStatus::TooFewRows);
    EXPECT_FALSE(found.initial.has_value());
  }
  EXPECT_EQ(refine_rigid(matches, {4, 7, 9}).status, RefineStatus::Refined);
  expect_no_pose(refine_rigid(testing::table_of_points({}, {}), {}), RefineStatus::TooFewRows);
}

TEST(RefineRigid, RowsWithoutExtentGiveNoPose) {
  const std::vector<testing::Row3> spread{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
  const std::vector<testing::Row3> line{{1, 1, 1}, {2, 3, 4}, {3, 5, 7}, {5, 9, 13}};
  const std::vector<testing::Row3> place{{4, 5, 6}, {4, 5, 6}, {4, 5, 6}, {4, 5, 6}};
  for (const auto& flat : {line, place}) {
    expect_no_pose(refine(testing::table_of_points(flat, flat)), RefineStatus::DegenerateGeometry);
    expect_no_pose(refine(testing::table_of_points(flat, spread)), RefineStatus::DegenerateGeometry);
    expect_no_pose(refine(testing::table_of_points(spread, flat)), RefineStatus::DegenerateGeometry);
    for (const auto& [source, target] :
         {std::pair{flat, flat}, {flat, spread}, {spread, flat}})  // nor does a start help
      expect_no_pose(refine_rigid(testing::table_of_points(source, target), {0, 1, 2, 3}, {}, RigidTransform()),
                     RefineStatus::DegenerateGeometry);
  }
  // One place, told apart by the last bit of its coordinates alone.
  CorrespondenceSet bits = testing::table_of_points(spread, spread);
  bits.source_points.array() = 1e6 + (bits.source_points.array() > 0).cast<double>() * 1.2e-10;
  expect_no_pose(refine(bits), RefineStatus::DegenerateGeometry);
  expect_no_pose(refine_rigid(bits, {0, 1, 2, 3}, {}, RigidTransform()), RefineStatus::DegenerateGeometry);
  // One match many times.
  const CorrespondenceSet matches = problem(10, 1, 0, 12).matches;
  expect_no_pose(refine_rigid(matches, {3, 3, 3, 3}), RefineStatus::DegenerateGeometry);
}

TEST(RefineRigid, HugeLengthsGiveAFinitePoseOrNone) {
  const CorrespondenceSet matches = problem(10, 1, 0.5, 13).matches;
  const RefinedPose large = refine(testing::scaled(matches, 1e100));
  ASSERT_EQ(large.status, RefineStatus::Refined);
  EXPECT_TRUE(large.covariance->allFinite());
  const RefinedPose huge = refine(testing::scaled(matches, 1e200));
  EXPECT_EQ(huge.status == RefineStatus::Refined, huge.target_from_source.has_value());
  if (huge.target_from_source) {
    EXPECT_TRUE(huge.target_from_source->rotation.allFinite());
    EXPECT_TRUE(huge.target_from_source->translation.allFinite());
  }
}

TEST(RefineRigid, RefusesWhatItCannotUse) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  CorrespondenceSet matches = problem(10, 1, 0, 14).matches;
  for (const int bad : {-1, 10, 2147483647}) EXPECT_THROW(refine_rigid(matches, {0, 1, 2, bad}), InvalidInput);
  for (const int bad : {-1, 10}) EXPECT_THROW(refine_rigid(matches, {bad}), InvalidInput);
  for (const double bad : {0.0, -5.0, std::nan(""), HUGE_VAL}) {
    RefineOptions options;
    options.loss_scale_pr = bad;
    EXPECT_THAT(testing::refusal_of([&] { refine(matches, options); }),
                AllOf(HasSubstr("loss_scale_pr"), HasSubstr("a finite number above zero")))
        << bad;
  }
  for (const int bad : {0, -1}) {
    RefineOptions options;
    options.maximum_iterations = bad;
    EXPECT_THAT(testing::refusal_of([&] { refine(matches, options); }),
                AllOf(HasSubstr("maximum_iterations"), HasSubstr("at least 1")));
  }
  RigidTransform scaled, mirrored, lost;
  scaled.rotation *= 2;
  mirrored.rotation(2, 2) = -1;
  lost.translation(1) = std::nan("");
  for (const RigidTransform& bad : {scaled, mirrored, lost})
    EXPECT_THAT(testing::refusal_of([&] { refine_rigid(matches, all_rows(matches), {}, bad); }),
                AllOf(HasSubstr("start"), HasSubstr("orthonormal rotation (to 1e-4) and a finite translation")));
  matches.target_points(3, 1) = std::nan("");
  EXPECT_THROW(refine(matches), InvalidInput);
}

TEST(RefineStatusText, IsWhatTheHeaderSays) {
  EXPECT_STREQ(to_text(RefineStatus::Refined), "refined");
  EXPECT_STREQ(to_text(RefineStatus::TooFewRows), "too few rows");
  EXPECT_STREQ(to_text(RefineStatus::DegenerateGeometry), "degenerate geometry");
  EXPECT_STREQ(to_text(RefineStatus::Diverged), "diverged");
}

TEST(RefineOverAll, TakesWhatTheSelectionMissedAndDropsWhatItHeldWrongly) {
  const SyntheticProblem made = testing::synthetic(300, 0.3, 11);
  RigidTransform start = made.truth;
  start.translation += Eigen::Vector3d(2, 0, 0);
  const RefinedPose refined = refine_over_all(made.matches, start);
  ASSERT_TRUE(refined.target_from_source);
  const auto error = [&](const RigidTransform& pose) {
    return point_error(pose, made.truth, made.matches.source_points, made.matches.resolution)->mean_pr;
  };
  EXPECT_LT(error(*refined.target_from_source), 0.3);
  const RefinedPose few = refine_rigid(made.matches, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {}, start);
  EXPECT_LT(error(*refined.target_from_source), error(few.target_from_source.value_or(start)));
  EXPECT_EQ(refine_over_all(testing::full_table(2), start).status, RefineStatus::TooFewRows);
}

}  // namespace
}  // namespace corral
