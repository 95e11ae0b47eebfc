// SPDX-License-Identifier: MIT
#include "refine/gram_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "kernel/random.h"

namespace corral {
namespace {

constexpr int kPairs = 60;

Eigen::Matrix<double, 13, 1> columns(const RigidTransform& motion) {
  Eigen::Matrix<double, 13, 1> x;
  Eigen::Map<Eigen::Matrix3d> change(x.data());
  change = motion.rotation - Eigen::Matrix3d::Identity();
  x.segment<3>(9) = motion.translation;
  x(12) = 1;
  return x;
}

/// The row of n . (R p + t - q), by the order of the columns of R - I.
Eigen::Matrix<double, 13, 1> residual_row(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                          const Eigen::Vector3d& n) {
  Eigen::Matrix<double, 13, 1> row;
  for (int j = 0; j < 3; ++j) row.segment<3>(3 * j) = p(j) * n;
  row.segment<3>(9) = n;
  row(12) = n.dot(p - q);
  return row;
}

struct Pairs {
  Points p{kPairs, 3}, q{kPairs, 3};
  Gram points = Gram::Zero(), planes = Gram::Zero();

  Pairs(const RigidTransform& motion, double noise, std::uint64_t seed) {
    RandomStream random(seed);
    for (int i = 0; i < kPairs; ++i) {
      const Eigen::Vector3d from = 10 * random.direction();
      const Eigen::Vector3d to = motion * from + noise * random.direction(), n = random.direction();
      p.row(i) = from.transpose();
      q.row(i) = to.transpose();
      const auto row = residual_row(from, to, n);
      planes += row * row.transpose();
      for (int axis = 0; axis < 3; ++axis) {
        const auto part = residual_row(from, to, Eigen::Vector3d::Unit(axis));
        points += part * part.transpose();
      }
    }
  }
};

RigidTransform motion_of(double angle, std::uint64_t seed) {
  RandomStream random(seed);
  return {Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix(), 5 * random.direction()};
}

TEST(GramFit, PointsGiveTheLeastSquaresMotion) {
  for (const double angle : {0.0, 0.01, 0.5, 1.5, 2.5})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Pairs pairs(motion_of(angle, seed), 0.5, seed);
      const auto found = minimise(pairs.points);
      const auto expected = fit_rigid_transform(pairs.p, pairs.q);
      ASSERT_TRUE(found.has_value());
      EXPECT_LT((found->motion.rotation - expected->rotation).norm(), 1e-7) << angle;
      EXPECT_LT((found->motion.translation - expected->translation).norm(), 1e-6) << angle;
    }
}

TEST(GramFit, PlanesGiveTheTruthWithoutNoise) {
  for (const double angle : {0.0, 0.01, 0.5}) {
    const RigidTransform truth = motion_of(angle, 3);
    const auto found = minimise(Pairs(truth, 0, 4).planes);
    EXPECT_LT((found->motion.rotation - truth.rotation).norm(), 1e-7) << angle;
    EXPECT_LT((found->motion.translation - truth.translation).norm(), 1e-6) << angle;
    EXPECT_TRUE(is_rotation(found->motion.rotation, 1e-12));
  }
}

TEST(GramFit, EndsInAMinimum) {
  RandomStream random(5);
  const Pairs pairs(motion_of(0.3, 6), 1, 7);
  const auto found = minimise(pairs.planes);
  const auto cost = [&](const RigidTransform& motion) { return columns(motion).dot(pairs.planes * columns(motion)); };
  EXPECT_NEAR(found->squares_before, cost({}), 1e-9 * cost({}));
  EXPECT_NEAR(found->squares_after, cost(found->motion), 1e-9 * cost({}));
  EXPECT_LT(found->squares_after, found->squares_before);
  for (int trial = 0; trial < 100; ++trial) {
    RigidTransform aside = found->motion;
    aside.rotation = Eigen::AngleAxisd(1e-3, random.direction()).toRotationMatrix() * aside.rotation;
    aside.translation += 1e-2 * random.direction();
    EXPECT_GT(cost(aside), cost(found->motion));
  }
}

/// Nothing to hold on to, and nothing that can be computed.
TEST(GramFit, EmptySumsMoveNothing) {
  const auto still = minimise(Gram::Zero());
  ASSERT_TRUE(still.has_value());
  EXPECT_EQ(still->motion.rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(still->motion.translation, Eigen::Vector3d::Zero());
  EXPECT_FALSE(minimise(Gram::Constant(std::numeric_limits<double>::quiet_NaN())).has_value());
}

}  // namespace
}  // namespace corral
