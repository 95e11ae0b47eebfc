// SPDX-License-Identifier: MIT
// What each loss promises: the truth from far starts, among gross errors, and a covariance that is right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <numeric>

#include "kernel/random.h"
#include "refine/refine_rigid.h"
#include "tests/refine/refine_problems.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::problem;

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::array<RobustLoss, 5> kLosses = {RobustLoss::None, RobustLoss::Huber, RobustLoss::Cauchy,
                                               RobustLoss::Tukey, RobustLoss::GemanMcClure};

const char* name(RobustLoss loss) { return choice_names(loss)[static_cast<std::size_t>(loss)]; }

Indices first_rows(int count) {
  Indices rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

RefinedPose refine(const CorrespondenceSet& matches, RobustLoss loss, double scale_pr = 5,
                   const std::optional<RigidTransform>& start = std::nullopt) {
  RefineOptions options;
  options.loss = loss;
  options.loss_scale_pr = scale_pr;
  return refine_rigid(matches, first_rows(matches.size()), options, start);
}

/// |A - B| over sqrt 2: the angle between two rotations that are close.
double small_angle(const RigidTransform& a, const RigidTransform& b) {
  return (a.rotation - b.rotation).norm() / std::sqrt(2.0);
}

/// The pose turned about the middle of the source points, and shifted.
RigidTransform aside(const SyntheticProblem& given, double angle_deg, double shift_pr, RandomStream& random) {
  const Eigen::Vector3d middle = given.truth * Eigen::Vector3d(given.matches.source_points.colwise().mean());
  RigidTransform pose = given.truth;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_deg * M_PI / 180, random.direction()).toRotationMatrix();
  pose.rotation = turn * pose.rotation;
  pose.translation =
      turn * (pose.translation - middle) + middle + shift_pr * given.matches.resolution * random.direction();
  return pose;
}

/// e^T C^-1 e of the pose change e that leads from the estimate to the truth: R_truth = exp([w]) R_estimate.
double normalised_error(const RigidTransform& truth, const RefinedPose& found) {
  const Eigen::AngleAxisd turn(truth.rotation * found.target_from_source->rotation.transpose());
  Vector6 error;
  error << turn.angle() * turn.axis(), truth.translation - found.target_from_source->translation;
  return error.dot(Vector6(found.covariance->fullPivLu().solve(error)));
}

struct Trials {
  int count, rows;
  double outliers;  ///< share of rows whose target is anywhere in the cube
  Eigen::Vector3d middle;
};

/// Mean of e^T C^-1 e over trials in a cube of 100 pr, noise 0.5 pr.
double mean_normalised_error(const Trials& trials, RobustLoss loss, double scale_pr) {
  RandomStream random(7);
  double sum = 0;
  const auto in_cube = [&] {
    return Eigen::Vector3d(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
  };
  for (int trial = 0; trial < trials.count; ++trial) {
    const RigidTransform truth{random.rotation(), 50 * random.direction()};
    CorrespondenceSet matches;
    matches.source_points.resize(trials.rows, 3);
    matches.target_points.resize(trials.rows, 3);
    for (int row = 0; row < trials.rows; ++row) {
      const Eigen::Vector3d point = trials.middle + in_cube();
      const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
      const bool is_wrong = row < trials.outliers * trials.rows;
      matches.source_points.row(row) = point.transpose();
      matches.target_points.row(row) =
          (is_wrong ? truth * (trials.middle + in_cube()) : truth * point + 0.5 * noise).transpose();
    }
    const RefinedPose found = refine(matches, loss, scale_pr);
    if (!found.covariance) return NAN;
    sum += normalised_error(truth, found);
  }
  return sum / trials.count;
}

TEST(RefineRigidLosses, TruthFromFarStartsWithoutNoise) {
  RandomStream random(1);
  for (const RobustLoss loss : kLosses)
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const SyntheticProblem given = problem(seed % 2 == 0 ? 4 : 60, 1, 0, seed, seed % 3 == 0 ? 0.01 : 1);
      const double angle = seed < 20 ? 30 : random.uniform(0, 30);
      const RefinedPose found = refine(given.matches, loss, 5, aside(given, angle, random.uniform(0, 100), random));
      ASSERT_EQ(found.status, RefineStatus::Refined) << name(loss) << seed;
      EXPECT_TRUE(found.converged) << name(loss) << seed;
      EXPECT_LT(small_angle(*found.target_from_source, given.truth), 1e-10) << name(loss) << seed;
      EXPECT_LT((found.target_from_source->translation - given.truth.translation).norm(),
                1e-10 * 200 * given.matches.resolution)
          << name(loss) << seed;
      EXPECT_GT(found.initial_rms_pr, 1);
      EXPECT_LT(found.final_rms_pr, 1e-8);
    }
}

TEST(RefineRigidLosses, SquaredErrorIsThatOfSixDegreesOfFreedom) {
  // With n = 3 * 100 - 6 degrees of freedom in s^2 the normalised error is 6 F(6, n): mean 6 n / (n - 2) = 6.04,
  // deviation 3.5, so the mean of 20,000 trials has a standard error of 0.025.
  EXPECT_NEAR(mean_normalised_error({20000, 100, 0, {0, 0, 0}}, RobustLoss::None, 5), 6, 0.1);
  // With 30 rows n is 84 and that mean 6.146; far from the origin turn and shift hang together.
  EXPECT_NEAR(mean_normalised_error({20000, 30, 0, {1000, -1000, 1000}}, RobustLoss::None, 5), 6.146, 0.1);
}

TEST(RefineRigidLosses, CovarianceHoldsForEveryLoss) {
  const Eigen::Vector3d middle(9, 99, 999);
  for (const RobustLoss loss : kLosses) {  // the standard error is 0.08
    EXPECT_NEAR(mean_normalised_error({2000, 60, 0, middle}, loss, 5), 6.07, 0.32) << name(loss);
    EXPECT_NEAR(mean_normalised_error({2000, 60, 0, middle}, loss, 1.5), 6.07, 0.5) << name(loss);  // deep in the loss
  }
  for (const RobustLoss loss : {RobustLoss::Cauchy, RobustLoss::Tukey, RobustLoss::GemanMcClure})
    EXPECT_NEAR(mean_normalised_error({2000, 60, 0.5, middle}, loss, 5), 6.1, 0.75) << name(loss);
}

TEST(RefineRigidLosses, HalfGrossErrors) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticProblem given = problem(400, 0.5, 0.5, seed);
    // The noise: the covariance of least squares over the correct matches alone. 6 degrees of freedom, 1e-6 beyond 38.
    RefineOptions plain;
    plain.loss = RobustLoss::None;
    const RefinedPose oracle = refine_rigid(given.matches, given.inliers, plain);
    const auto error_of = [&](RobustLoss loss, double scale_pr) {
      RefinedPose found = refine(given.matches, loss, scale_pr);
      found.covariance = oracle.covariance;
      return normalised_error(given.truth, found);
    };
    for (const RobustLoss loss : {RobustLoss::Cauchy, RobustLoss::Tukey, RobustLoss::GemanMcClure})
      EXPECT_LT(error_of(loss, 5), 38) << name(loss) << seed;
    EXPECT_LT(error_of(RobustLoss::Huber, 0.5), 4 * 38) << seed;  // its pull is bounded, not gone: twice the noise
    EXPECT_GT(error_of(RobustLoss::None, 5), 100 * 38) << seed;
  }
}

TEST(RefineRigidLosses, CostNeverRises) {
  RandomStream random(3);
  for (const RobustLoss loss : kLosses)
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      const SyntheticProblem given = problem(30, 0.1 * static_cast<double>(seed % 11), seed % 2, seed);
      std::optional<RigidTransform> start;  // the truth is where rounds of graduation have the most to lose
      if (seed % 3 > 0) start = aside(given, seed % 3 == 1 ? 0 : random.uniform(0, 180), 0, random);
      RefineOptions options;
      options.loss = loss;
      options.loss_scale_pr = seed % 4 == 0 ? 50 : 2;
      options.maximum_iterations = seed % 5 == 0 ? 3 : 300;
      const RefinedPose found = refine_rigid(given.matches, first_rows(30), options, start);
      if (!found.target_from_source) {
        EXPECT_EQ(found.status, RefineStatus::Diverged);
        EXPECT_EQ(loss, RobustLoss::Tukey) << name(loss) << seed;  // the only one that may lose all rows
        continue;
      }
      EXPECT_LE(found.final_cost, found.initial_cost) << name(loss) << seed;
      EXPECT_LE(found.iterations, options.maximum_iterations);
    }
}

TEST(RefineRigidLosses, LeastSquaresNeedsNoStep) {
  const SyntheticProblem given = problem(60, 0.7, 0.5, 5);
  const RefinedPose found = refine(given.matches, RobustLoss::None);
  EXPECT_LT(small_angle(*found.target_from_source, *found.initial), 1e-12);
  EXPECT_LE(found.iterations, 1);
  EXPECT_NEAR(found.final_cost, 60 * found.final_rms_pr * found.final_rms_pr, 1e-9 * found.final_cost);
}

TEST(RefineRigidLosses, ConditionIsThatOfTheCentredRows) {
  // The corners of an octahedron of radius 3: sum |x|^2 I - x x^T = 36 I about any axis, and 6 I for the shift.
  const std::vector<testing::Row3> corners{{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {0, 0, 3}, {0, 0, -3}};
  CorrespondenceSet matches = testing::table_of_points(corners, corners);
  EXPECT_NEAR(*refine(matches, RobustLoss::None).condition, 6, 1e-9);
  matches.target_points.rowwise() += Eigen::RowVector3d(1000, 0, 0);
  EXPECT_NEAR(*refine(matches, RobustLoss::None).condition, 6, 1e-9);
  EXPECT_NEAR(*refine(testing::scaled(matches, 0.25), RobustLoss::Tukey).condition, 6, 1e-9);
  matches.resolution = 0.5;  // twice as many pr
  EXPECT_NEAR(*refine(matches, RobustLoss::None).condition, 24, 1e-9);
}

TEST(RefineRigidLosses, RowsThatKeepTheirWeightMustFixThePose) {
  // Ten correct matches on a line, two incorrect ones beside it: without them the rotation about the line is undetermined.
  CorrespondenceSet matches = testing::table_on_line({0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 45, 45},
                                                     {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 45, 45});
  matches.source_points(10, 1) = 30, matches.source_points(11, 1) = -30;
  matches.target_points(10, 1) = 300, matches.target_points(11, 2) = 400;
  for (const double thickness_pr : {0.0, 0.01}) {  // the second is no line, to rounding, but thinner than a thousandth
    matches.source_points(3, 1) = matches.target_points(3, 1) = thickness_pr;
    const RefinedPose found = refine(matches, RobustLoss::Tukey, 5, RigidTransform());
    EXPECT_EQ(found.status, RefineStatus::Diverged);
    EXPECT_FALSE(found.target_from_source || found.covariance || found.condition || found.converged);
    EXPECT_TRUE(found.initial.has_value());
  }
  matches.source_points(3, 1) = matches.target_points(3, 1) = 1;
  EXPECT_EQ(refine(matches, RobustLoss::Tukey, 5, RigidTransform()).status, RefineStatus::Refined);
}

TEST(RefineRigidLosses, StartDecidesAmongTwoPoses) {
  // Half the rows moved one way, half another, both by far more than the scale.
  SyntheticProblem given = problem(60, 1, 0, 6);
  const RigidTransform other{Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix(), {70, -80, 90}};
  for (int row = 0; row < 30; ++row)
    given.matches.target_points.row(row) = (other * given.matches.source_points.row(row).transpose()).transpose();
  for (const RobustLoss loss : {RobustLoss::Cauchy, RobustLoss::Tukey})  // equal costs under tukey: the start stands
    for (const RigidTransform& pose : {given.truth, other}) {
      const RefinedPose found = refine(given.matches, loss, 0.01, pose);
      EXPECT_LT(small_angle(*found.target_from_source, pose), 1e-4) << name(loss);
      EXPECT_EQ(found.initial->rotation, pose.rotation);
      EXPECT_EQ(found.initial->translation, pose.translation);
    }
}

TEST(RefineRigidLosses, TwiceTheSameBytes) {
  const CorrespondenceSet matches = problem(150, 0.6, 0.5, 8).matches;
  const auto same = [](const auto& a, const auto& b) {
    return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
  };
  for (const RobustLoss loss : kLosses) {
    const RefinedPose first = refine(matches, loss), second = refine(matches, loss);
    EXPECT_TRUE(same(first.target_from_source->rotation, second.target_from_source->rotation));
    EXPECT_TRUE(same(first.target_from_source->translation, second.target_from_source->translation));
    EXPECT_TRUE(same(*first.covariance, *second.covariance));
    EXPECT_EQ(first.iterations, second.iterations);
    EXPECT_EQ(first.final_cost, second.final_cost);
    EXPECT_EQ(first.condition, second.condition);
  }
}

TEST(RefineRigidLosses, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  const SyntheticProblem given = problem(30, 0.1, 0.5, 9);
  RandomStream random(9);
  for (int trial = 0; trial < 50; ++trial)
    for (const RobustLoss loss : kLosses) refine(given.matches, loss, 0.1, aside(given, 180, 500, random));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace corral
