// SPDX-License-Identifier: MIT
#include "kernel/triangle_fit.h"

#include <gtest/gtest.h>

#include <array>

#include "kernel/random.h"
#include "tests/support/execution.h"

namespace corral {
namespace {

using testing::available_targets;
using testing::ForcedTarget;

struct Fit {
  RigidTransform motion;
  bool is_usable;
};

/// The fit of the triangles in lane 5; those in the other lanes are degenerate.
Fit fit_in_lanes(const Points& source, const Points& target, double smallest_area) {
  LaneTriangles corners[2] = {};
  LaneMotions motions;
  corners[0].set(5, source, std::array{0, 1, 2});
  corners[1].set(5, target, std::array{0, 1, 2});
  fit_triangles(corners[0], corners[1], smallest_area, motions);
  for (int lane = 0; lane < kLanes; ++lane) EXPECT_TRUE(lane == 5 || !motions.is_usable(lane)) << lane;
  return {motions.get(5), motions.is_usable(5)};
}

Points random_points(RandomStream& random, double extent) {
  Points points(3, 3);
  for (int i = 0; i < 9; ++i) points(i / 3, i % 3) = random.uniform(-extent, extent);
  return points;
}

TEST(TriangleFit, IsTheLeastSquaresMotion) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
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

TEST(TriangleFit, IsTheSameOnEveryTarget) {
  RandomStream random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Points source = random_points(random, 10), target = random_points(random, 1);
    const Fit best = fit_in_lanes(source, target, 0);
    for (const std::int64_t each : available_targets()) {
      const ForcedTarget forced(each);
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
