// SPDX-License-Identifier: MIT
#include "refine/rigid_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "kernel/random.h"

namespace corral {
namespace {

constexpr std::array<RobustLoss, 5> kLosses = {RobustLoss::None, RobustLoss::Huber, RobustLoss::Cauchy,
                                               RobustLoss::Tukey, RobustLoss::GemanMcClure};

TEST(RobustLoss, WeightAndBendAreTheDerivatives) {
  for (const RobustLoss kind : kLosses)
    for (const double scale : {0.5, 3.0})
      for (const double squared : {0.01, 0.2, 1.0, 8.0, 10.0, 300.0}) {
        const ScaledLoss loss{kind, scale};
        const double h = 1e-6 * squared;
        const LossValue at = evaluate_loss(loss, squared), below = evaluate_loss(loss, squared - h),
                        above = evaluate_loss(loss, squared + h);
        EXPECT_NEAR(at.weight, (above.cost - below.cost) / (2 * h), 1e-7) << int(kind) << " " << squared;
        EXPECT_NEAR(at.bend, squared * (above.weight - below.weight) / (2 * h), 1e-7) << int(kind) << " " << squared;
        EXPECT_GE(at.weight, 0);
        EXPECT_LE(at.weight, 1);
        EXPECT_LE(at.bend, 0);                                  // concave, and so
        EXPECT_GE(at.cost, squared * at.weight * (1 - 1e-12));  // what the residuals given to Ceres rest on
        EXPECT_LE(at.cost, squared * (1 + 1e-12));
      }
}

TEST(RobustLoss, IsLeastSquaresForSmallResidualsAndHasItsLimits) {
  for (const RobustLoss kind : kLosses) {
    EXPECT_NEAR(evaluate_loss({kind, 4}, 1e-6).cost, 1e-6, 1e-12);
    EXPECT_EQ(evaluate_loss({kind, 4}, 0).cost, 0);
    EXPECT_EQ(evaluate_loss({kind, 4}, 0).weight, 1);
  }
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::None, 2}, 100).cost, 100);
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::Huber, 2}, 100).cost, 36);  // 2 2 10 - 4
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::Cauchy, 2}, 4).cost, 4 * std::log(2.0));
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::Tukey, 3}, 9).cost, 3);
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::Tukey, 3}, 1e9).cost, 3);
  EXPECT_EQ(evaluate_loss({RobustLoss::Tukey, 3}, 9.1).weight, 0);
  EXPECT_DOUBLE_EQ(evaluate_loss({RobustLoss::GemanMcClure, 2}, 4).cost, 2);
  EXPECT_NEAR(evaluate_loss({RobustLoss::GemanMcClure, 2}, 1e9).cost, 4, 1e-7);
}

TEST(RobustLoss, GraduationBeginsWhereTheLossIsConvex) {
  const auto curvature = [](RobustLoss kind, double residual) {  // of rho(r^2), over 2
    const LossValue at = evaluate_loss({kind, 3}, residual * residual);
    return at.weight + 2 * at.bend;
  };
  for (const RobustLoss kind : {RobustLoss::Tukey, RobustLoss::GemanMcClure}) {
    EXPECT_GT(curvature(kind, 2.99 * graduation_reach(kind)), 0);
    EXPECT_LT(curvature(kind, 3.01 * graduation_reach(kind)), 0);
  }
  for (const RobustLoss kind : {RobustLoss::None, RobustLoss::Huber, RobustLoss::Cauchy})
    EXPECT_EQ(graduation_reach(kind), HUGE_VAL);
}

using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 6, 1>>;
using DualVector = Eigen::Matrix<Dual, 3, 1>;

/// e of a pose turned by exp([w]) and shifted by d, with its derivative by (w, d) at 0, where exp([w]) is I + [w].
DualVector residual(const Eigen::Vector3d& source, const Eigen::Vector3d& target, const RigidTransform& pose) {
  DualVector turn, error;
  for (int i = 0; i < 3; ++i) turn(i) = Dual(0, 6, i), error(i) = Dual(pose.translation(i) - target(i), 6, 3 + i);
  const DualVector arm = (pose.rotation * source).cast<Dual>();
  return error + arm + turn.cross(arm);
}

TEST(RigidCost, FollowsAutomaticDerivatives) {
  RandomStream random(1);
  for (const RobustLoss kind : kLosses)
    for (int trial = 0; trial < 20; ++trial) {
      const RigidTransform pose{random.rotation(), 3 * random.direction()};
      MatchedPoints pairs{Points(9, 3), Points(9, 3)};
      for (int row = 0; row < 9; ++row) {
        pairs.source.row(row) = random.uniform(0, 40) * random.direction().transpose();
        pairs.target.row(row) =
            (pose * Eigen::Vector3d(pairs.source.row(row).transpose()) + random.uniform(0, 12) * random.direction())
                .transpose();
      }
      const ScaledLoss loss{kind, 5};
      Dual cost(0, Eigen::Matrix<double, 6, 1>::Zero());
      RigidCost expected;
      for (int row = 0; row < 9; ++row) {
        const DualVector error = residual(pairs.source.row(row), pairs.target.row(row), pose);
        Eigen::Vector3d value;
        Eigen::Matrix<double, 3, 6> jacobian;
        for (int i = 0; i < 3; ++i) value(i) = error(i).value(), jacobian.row(i) = error(i).derivatives();
        const LossValue at = evaluate_loss(loss, value.squaredNorm());
        expected.cost += at.cost;
        expected.gradient += at.weight * jacobian.transpose() * value;
        expected.normal += at.weight * jacobian.transpose() * jacobian;
      }
      const RigidCost found = rigid_cost(pairs, pose, loss);
      EXPECT_NEAR(found.cost, expected.cost, 1e-12 * expected.cost);
      EXPECT_LT((found.gradient - expected.gradient).norm(), 1e-11 * expected.gradient.norm());
      EXPECT_LT((found.normal - expected.normal).norm(), 1e-12 * expected.normal.norm());
    }
}

TEST(RigidCost, QuaternionChangesTurnAsSaid) {
  RandomStream random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Quaterniond rotation(random.rotation());
    EXPECT_LT((turn_by_quaternion(rotation) * rotation.coeffs()).norm(), 1e-15);  // its length turns nothing
    for (int i = 0; i < 4; ++i) {
      const double h = 1e-6;
      Eigen::Quaterniond ahead = rotation, behind = rotation;
      ahead.coeffs()(i) += h, behind.coeffs()(i) -= h;
      const Eigen::Quaterniond change = ahead.normalized() * behind.normalized().conjugate();
      EXPECT_LT((turn_by_quaternion(rotation).col(i) - change.vec() / h).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace corral
