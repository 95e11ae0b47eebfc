// SPDX-License-Identifier: MIT
#include "kernel/triangle_fit.h"

#include <gtest/gtest.h>

#include "kernel/random.h"
#include "kernel/rigid_transform.h"
#include "tests/support/execution.h"

namespace corral {
namespace {

using testing::available_levels;
using testing::ForcedLevel;

struct Fit {
  RigidTransform motion;
  bool is_usable;
};

/// The fit of the triangles in lane 5; those in the other lanes are degenerate.
Fit fit_in_lanes(const Points& source, const Points& target, double smallest_area) {
  alignas(64) double corners[2][3][3][kLanes] = {};
  double numbers[13][kLanes];
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      corners[0][corner][axis][5] = source(corner, axis);
      corners[1][corner][axis][5] = target(corner, axis);
    }
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    LanePoint<Lanes> p[2][3];
    for (int side = 0; side < 2; ++side)
      for (int corner = 0; corner < 3; ++corner)
        p[side][corner] = {Lanes::load(corners[side][corner][0]), Lanes::load(corners[side][corner][1]),
                           Lanes::load(corners[side][corner][2])};
    const auto motion = fit_triangle(p[0], p[1], smallest_area);
    const LanePoint<Lanes> rows[4] = {motion.rows[0], motion.rows[1], motion.rows[2], motion.translation};
    for (int i = 0; i < 4; ++i)
      rows[i].x.store(numbers[3 * i]), rows[i].y.store(numbers[3 * i + 1]), rows[i].z.store(numbers[3 * i + 2]);
    motion.usable.store(numbers[12]);
  });
  for (int lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(lane == 5 || numbers[12][lane] == 0) << lane;
  Fit fit;
  for (int i = 0; i < 9; ++i) fit.motion.rotation(i / 3, i % 3) = numbers[i][5];
  for (int i = 0; i < 3; ++i) fit.motion.translation(i) = numbers[9 + i][5];
  fit.is_usable = numbers[12][5] == 1;
  return fit;
}

Points random_points(RandomStream& random, double extent) {
  Points points(3, 3);
  for (int i = 0; i < 9; ++i) points(i / 3, i % 3) = random.uniform(-extent, extent);
  return points;
}

TEST(TriangleFit, IsTheLeastSquaresMotion) {
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    RandomStream random(1);
    for (int trial = 0; trial < 2000; ++trial) {
      const Points source = random_points(random, 10);
      Points target = random_points(random, 10);
      if (trial % 3 > 0)  // nearly, or all but exactly, the same triangle moved
        target = RigidTransform{random.rotation(), 5 * random.direction()}.apply(source) +
                 (trial % 3 == 1 ? 0.3 : 1e-9) * random_points(random, 1);
      const auto expected = fit_rigid_transform(source, target);
      const Fit found = fit_in_lanes(source, target, 1e-3);
      ASSERT_TRUE(expected && found.is_usable);
      EXPECT_TRUE(is_rotation(found.motion.rotation, 1e-12));
      EXPECT_LT((found.motion.rotation - expected->rotation).cwiseAbs().maxCoeff(), 1e-9) << trial;
      EXPECT_LT((found.motion.translation - expected->translation).cwiseAbs().maxCoeff(), 1e-8) << trial;
    }
  }
}

TEST(TriangleFit, IsTheSameOnEveryLevel) {
  RandomStream random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Points source = random_points(random, 10), target = random_points(random, 1);
    const Fit best = fit_in_lanes(source, target, 0);
    for (const VectorLevel level : available_levels()) {
      const ForcedLevel forced(level);
      const Fit fit = fit_in_lanes(source, target, 0);
      EXPECT_EQ(fit.motion.rotation, best.motion.rotation);
      EXPECT_EQ(fit.motion.translation, best.motion.translation);
    }
  }
}

TEST(TriangleFit, HalfATurn) {
  Points source(3, 3), target(3, 3);
  source << 0, 0, 0, 4, 0, 0, 0, 2, 0;
  target << 0, 0, 0, -4, 0, 0, 0, -2, 0;
  const Fit fit = fit_in_lanes(source, target, 1e-3);
  EXPECT_TRUE(fit.is_usable);
  EXPECT_TRUE(fit.motion.rotation.isApprox(Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix(), 1e-15));
  EXPECT_TRUE(fit.motion.translation.isZero(1e-15));
}

TEST(TriangleFit, DegenerateTrianglesAreNotUsable) {
  Points good(3, 3), small(3, 3), line(3, 3), place(3, 3), broken(3, 3);
  good << 0, 0, 0, 4, 0, 0, 0, 2, 0;
  small << 0, 0, 0, 0.02, 0, 0, 0, 0.1, 0;  // area 1e-3
  line << 0, 0, 0, 1, 1, 1, 3, 3, 3;
  place << 1, 2, 3, 1, 2, 3, 1, 2, 3;
  broken << 0, 0, 0, 4, std::nan(""), 0, 0, 2, 0;
  for (const Points& bad : {line, place, broken}) {
    EXPECT_FALSE(fit_in_lanes(good, bad, 1e-3).is_usable);
    EXPECT_FALSE(fit_in_lanes(bad, good, 1e-3).is_usable);
    EXPECT_FALSE(fit_in_lanes(bad, bad, 0).is_usable);
  }
  EXPECT_FALSE(fit_in_lanes(good, small, 1.0001e-3).is_usable);
  EXPECT_TRUE(fit_in_lanes(good, small, 0.9999e-3).is_usable);
  Points needle(3, 3);  // large enough, but its second singular value is 1e-8 of the first
  needle << 0, 0, 0, 2000, 0, 0, 1000, 0.1, 0;
  EXPECT_FALSE(fit_in_lanes(needle, needle, 1e-3).is_usable);
  EXPECT_FALSE(fit_rigid_transform(needle, needle).has_value());
}

}  // namespace
}  // namespace corral
