// SPDX-License-Identifier: MIT
#include "kernel/rigid_transform.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

constexpr double kPi = 3.14159265358979323846;

Points cloud(int count, RandomStream& random) {
  Points points(count, 3);
  for (int row = 0; row < count; ++row)
    for (int axis = 0; axis < 3; ++axis) points(row, axis) = random.uniform(-1, 1);
  return points;
}

double sum_of_squares(const RigidTransform& motion, const Points& source, const Points& target) {
  return (motion.apply(source) - target).squaredNorm();
}

void expect_recovers(const Points& source, const RigidTransform& motion, double tolerance) {
  const auto found = fit_rigid_transform(source, motion.apply(source));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->rotation - motion.rotation).norm(), tolerance);
  EXPECT_LT((found->apply(source) - motion.apply(source)).rowwise().norm().maxCoeff(), tolerance * 10);
  EXPECT_TRUE(is_rotation(found->rotation, 1e-13));
}

TEST(RigidTransform, ComposesInvertsAndApplies) {
  RandomStream random(1);
  const RigidTransform b_from_a{random.rotation(), random.direction()}, c_from_b{random.rotation(), random.direction()};
  const RigidTransform c_from_a = c_from_b * b_from_a;
  const Points points = cloud(5, random);
  for (int row = 0; row < 5; ++row) {
    const Eigen::Vector3d x = points.row(row).transpose();
    EXPECT_LT((c_from_a * x - c_from_b * (b_from_a * x)).norm(), 1e-14);
    EXPECT_LT((b_from_a.inverse() * (b_from_a * x) - x).norm(), 1e-14);
    EXPECT_LT((b_from_a.apply(points).row(row).transpose() - b_from_a * x).norm(), 1e-14);
  }
  // A quarter turn about z takes x to y, then the shift.
  RigidTransform turn;
  turn.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  turn.translation << 10, 20, 30;
  EXPECT_EQ(turn * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(10, 21, 30));
  EXPECT_EQ(turn.apply(Points(0, 3)).rows(), 0);
}

TEST(IsRotation, TellsRotationsFromTheRest) {
  RandomStream random(2);
  for (int trial = 0; trial < 100; ++trial) EXPECT_TRUE(is_rotation(random.rotation(), 1e-14));
  EXPECT_FALSE(is_rotation(-Eigen::Matrix3d::Identity(), 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Vector3d(1, 1, -1).asDiagonal(), 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Matrix3d::Zero(), 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Matrix3d::Constant(std::nan("")), 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Matrix3d::Identity() * HUGE_VAL, 1e-3));
  const Eigen::Matrix3d stretched = Eigen::Vector3d(1, 1, 1 + 1e-4).asDiagonal();  // R R^T is off by 2e-4
  EXPECT_TRUE(is_rotation(stretched, 2.1e-4));
  EXPECT_FALSE(is_rotation(stretched, 1.9e-4));
  Eigen::Matrix3d sheared = Eigen::Matrix3d::Identity();
  sheared(0, 1) = 1e-3;
  EXPECT_FALSE(is_rotation(sheared, 0.9e-3));
  EXPECT_TRUE(is_rotation(sheared, 1.1e-3));
}

TEST(FitRigidTransform, RecoversRandomMotions) {
  RandomStream random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const RigidTransform motion{random.rotation(), 5 * random.direction()};
    expect_recovers(cloud(4 + trial % 50, random), motion, 1e-12);
  }
}

TEST(FitRigidTransform, ThreePoints) {
  RandomStream random(4);
  for (int trial = 0; trial < 100; ++trial)
    expect_recovers(points_of({{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0.5}}), {random.rotation(), random.direction()}, 1e-12);
}

TEST(FitRigidTransform, PlanarSet) {
  RandomStream random(5);
  for (int trial = 0; trial < 100; ++trial) {
    Points flat = cloud(20, random);
    flat.col(2).setConstant(3);
    expect_recovers(flat, {random.rotation(), random.direction()}, 1e-12);
  }
}

TEST(FitRigidTransform, HalfTurns) {
  RandomStream random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3d half = Eigen::AngleAxisd(kPi, random.direction()).toRotationMatrix();
    expect_recovers(cloud(10, random), {half, random.direction()}, 1e-12);
  }
}

TEST(FitRigidTransform, MirroredTargetGivesTheBestProperMotion) {
  RandomStream random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Points source = cloud(30, random);
    Points target = source;
    target.col(trial % 3) *= -1;
    const auto found = fit_rigid_transform(source, target);
    ASSERT_TRUE(found.has_value());
    EXPECT_TRUE(is_rotation(found->rotation, 1e-13));
    const double best = sum_of_squares(*found, source, target);
    for (int other = 0; other < 200; ++other) {
      RigidTransform aside{random.rotation(), Eigen::Vector3d::Zero()};
      if (other % 2 == 0)
        aside.rotation = Eigen::AngleAxisd(0.01, random.direction()).toRotationMatrix() * found->rotation;
      aside.translation = (target.colwise().mean() - aside.apply(source).colwise().mean()).transpose();
      EXPECT_GE(sum_of_squares(aside, source, target), best);
    }
  }
}

TEST(FitRigidTransform, IsTheLeastSquaresSolutionUnderNoise) {
  RandomStream random(8);
  for (int trial = 0; trial < 50; ++trial) {
    const Points source = cloud(12, random), target = cloud(12, random);
    const auto found = fit_rigid_transform(source, target);
    ASSERT_TRUE(found.has_value());
    for (int other = 0; other < 50; ++other) {
      RigidTransform aside = *found;
      aside.rotation = Eigen::AngleAxisd(0.01, random.direction()).toRotationMatrix() * aside.rotation;
      EXPECT_GE(sum_of_squares(aside, source, target), sum_of_squares(*found, source, target));
      aside = *found;
      aside.translation += 0.01 * random.direction();
      EXPECT_GT(sum_of_squares(aside, source, target), sum_of_squares(*found, source, target));
    }
  }
}

TEST(FitRigidTransform, LargeOffsetsCostOnlyTheirRounding) {
  RandomStream random(9);
  const RigidTransform turn{random.rotation(), Eigen::Vector3d::Zero()};
  const Points source = cloud(30, random);
  const auto found = fit_rigid_transform(source.array() + 1e7, turn.apply(source).array() - 1e7);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->rotation - turn.rotation).norm(), 1e-8);  // coordinates near 1e7 are kept to 2e-9
  EXPECT_LT((found->apply(source.array() + 1e7) - (turn.apply(source).array() - 1e7).matrix()).norm(), 1e-6);
}

TEST(FitRigidTransform, DegenerateRowsGiveNoMotion) {
  const Points spread = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  const Points place = points_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  const Points line = points_of({{1, 1, 1}, {2, 3, 4}, {3, 5, 7}, {10, 19, 28}});
  for (const Points& flat : {place, line}) {
    EXPECT_FALSE(fit_rigid_transform(flat, flat).has_value());
    EXPECT_FALSE(fit_rigid_transform(spread, flat).has_value());
    EXPECT_FALSE(fit_rigid_transform(flat, spread).has_value());
    EXPECT_FALSE(fit_rigid_transform(flat.array() + 1e7, flat.array() + 1e7).has_value());
  }
  for (int rows = 0; rows < 3; ++rows)
    EXPECT_FALSE(fit_rigid_transform(Points(spread.topRows(rows)), Points(spread.topRows(rows))).has_value());
}

TEST(FitRigidTransform, LimitOfTheSecondSingularValue) {
  // H = diag(2, 2 w^2, 0) for a cross of arms 1 and w: refused for w^2 <= 1e-6.
  for (const double w : {0.9e-3, 1.1e-3}) {
    const Points cross = points_of({{1, 0, 0}, {-1, 0, 0}, {0, w, 0}, {0, -w, 0}});
    EXPECT_EQ(fit_rigid_transform(cross, cross).has_value(), w > 1e-3);
  }
}

TEST(FitRigidTransform, NotFiniteGivesNoMotion) {
  RandomStream random(10);
  const Points good = cloud(6, random);
  for (const double bad : {std::nan(""), HUGE_VAL, 1e300}) {
    Points broken = good;
    broken(2, 1) = bad;
    EXPECT_FALSE(fit_rigid_transform(broken, good).has_value()) << bad;
    EXPECT_FALSE(fit_rigid_transform(good, broken).has_value()) << bad;
  }
}

TEST(FitRigidTransform, SidesMustBeEquallyLong) {
  EXPECT_THROW(fit_rigid_transform(Points::Random(4, 3), Points::Random(5, 3)), InvalidInput);
  EXPECT_THROW(fit_rigid_transform(Points(0, 3), Points::Random(1, 3)), InvalidInput);
}

TEST(FitRigidTransform, OfATableTakesTheChosenRows) {
  RandomStream random(11);
  CorrespondenceSet matches;
  matches.source_points = cloud(8, random);
  const RigidTransform motion{random.rotation(), random.direction()};
  matches.target_points = motion.apply(matches.source_points);
  for (const int wrong : {1, 4}) matches.target_points.row(wrong) *= -3;
  const auto found = fit_rigid_transform(matches, {0, 2, 3, 5, 6, 7});
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->rotation - motion.rotation).norm(), 1e-12);
  EXPECT_FALSE(fit_rigid_transform(matches, {0, 2}).has_value());
  EXPECT_FALSE(fit_rigid_transform(matches, {}).has_value());
}

TEST(TriangleArea, IsHalfBaseTimesHeight) {
  EXPECT_DOUBLE_EQ(triangle_area({0, 0, 0}, {4, 0, 0}, {1, 0, 3}), 6);
  EXPECT_DOUBLE_EQ(triangle_area({1e7, 0, 0}, {1e7 + 4, 0, 0}, {1e7, 3, 0}), 6);
  EXPECT_EQ(triangle_area({0, 0, 0}, {1, 2, 3}, {2, 4, 6}), 0);
  EXPECT_EQ(triangle_area({1, 2, 3}, {1, 2, 3}, {5, 5, 5}), 0);
}

TEST(FitRigidTransform, ARowThatIsNotThereIsAnError) {
  CorrespondenceSet matches;
  matches.source_points = matches.target_points = Points::Random(4, 3);
  EXPECT_TRUE(fit_rigid_transform(matches, {0, 1, 2}).has_value());
  EXPECT_THROW(fit_rigid_transform(matches, {0, 1, 4}), InvalidInput);
  EXPECT_THROW(fit_rigid_transform(matches, {-1, 1, 2}), InvalidInput);
}

}  // namespace
}  // namespace corral
