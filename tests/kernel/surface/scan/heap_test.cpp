// SPDX-License-Identifier: MIT
// Heaps: nothing touches, nothing floats.
#include "kernel/surface/scan/heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "kernel/surface/search/nearest_points.h"
#include "tests/support/scanned.h"

namespace corral {
namespace {

using testing::bumpy_sphere;
using testing::icosphere;
using testing::shift;

constexpr double kGap = 0.02;

/// Long, flat and round things.
std::vector<SurfaceTree> things() {
  std::vector<SurfaceTree> surfaces;
  for (const Eigen::RowVector3d& scale : {Eigen::RowVector3d(1, 0.4, 0.3), {1, 1, 0.3}, {1, 1, 1}, {0.3, 1.2, 0.5}}) {
    Mesh mesh = bumpy_sphere(3, surfaces.size());
    mesh.vertices = mesh.vertices * scale.asDiagonal();
    surfaces.emplace_back(mesh);
  }
  return surfaces;
}

PosedSurfaces heaped(const std::vector<SurfaceTree>& surfaces, std::uint64_t seed) {
  std::vector<const SurfaceTree*> pointers;
  for (const SurfaceTree& surface : surfaces) pointers.push_back(&surface);
  const std::vector<RigidTransform> poses = heap(pointers, kGap, seed);
  PosedSurfaces posed;
  for (std::size_t i = 0; i < poses.size(); ++i) posed.push_back({pointers[i], poses[i]});
  return posed;
}

Points placed(const PosedSurface& posed) { return posed.world_from_mesh.apply(posed.surface->mesh().vertices); }

TEST(FreePath, OfABallToABall) {
  const SurfaceTree ball(icosphere(4));
  const PosedSurface here{&ball, {}};
  EXPECT_NEAR(free_path(here, {{&ball, shift(5, 0, 0)}}, {1, 0, 0}), 3, 0.01);
  EXPECT_NEAR(free_path(here, {{&ball, shift(9, 0, 0)}, {&ball, shift(5, 1, 0)}}, {1, 0, 0}), 5 - std::sqrt(3.0), 0.01);
  EXPECT_EQ(free_path(here, {{&ball, shift(5, 0, 0)}}, {-1, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(free_path(here, {{&ball, shift(5, 2.1, 0)}}, {1, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(free_path(here, {}, {1, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(FreePath, SeesASmallThingBeforeALargeFaceAndBehindIt) {
  Mesh wall = testing::grid(2, 2, 20);
  wall.vertices.rowwise() -= Eigen::RowVector3d(10, 10, 0);
  const SurfaceTree large(wall), small(icosphere(2, 0.1));
  EXPECT_NEAR(free_path({&large, {}}, {{&small, shift(1, 2, 4)}}, {0, 0, 1}), 3.9, 0.01) << "no corner of it is near";
  EXPECT_NEAR(free_path({&small, shift(1, 2, 4)}, {{&large, {}}}, {0, 0, -1}), 3.9, 0.01);
}

TEST(Touch, AsTheyStand) {
  const SurfaceTree ball(icosphere(3));
  EXPECT_TRUE(touch({&ball, shift(10, 0, 0)}, {&ball, shift(11.9, 0, 0)}));
  EXPECT_FALSE(touch({&ball, shift(10, 0, 0)}, {&ball, shift(12.1, 0, 0)}));
}

TEST(Heap, NothingTouchesAndNothingIsInsideAnother) {
  const std::vector<SurfaceTree> surfaces = things();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const PosedSurfaces posed = heaped(surfaces, seed);
    for (std::size_t i = 0; i < posed.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_FALSE(touch(posed[i], posed[j])) << seed;
        const Eigen::Vector3d ball = posed[i].world_from_mesh.translation;  // the middle of each is inside it
        EXPECT_GT((ball - posed[j].world_from_mesh.translation).norm(), 0.3) << seed;
      }
  }
}

TEST(Heap, NothingFloats) {
  const std::vector<SurfaceTree> surfaces = things();
  int leaning = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const PosedSurfaces posed = heaped(surfaces, seed);
    EXPECT_NEAR(placed(posed[0]).col(2).minCoeff(), 0, 1e-12);
    for (std::size_t i = 1; i < posed.size(); ++i) {
      const double lowest = placed(posed[i]).col(2).minCoeff();
      EXPECT_GE(lowest, -1e-9) << "through the floor";
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < i; ++j) {
        const PointTree tree(placed(posed[j]));
        const Points own = placed(posed[i]), other = placed(posed[j]);
        const Indices found = NearestTracker(tree).nearest(own, 10);
        for (Eigen::Index row = 0; row < own.rows(); ++row)
          nearest = std::min(nearest, (own.row(row) - other.row(found[static_cast<std::size_t>(row)])).norm());
      }
      // Corners of a mesh are up to some 0.1 from each other where faces meet.
      EXPECT_TRUE(nearest < 0.25 || lowest < 3 * kGap) << seed << ": " << nearest << " from the others";
      leaning += nearest < 0.25;
    }
  }
  EXPECT_GT(leaning, 14) << "of 18";
}

TEST(Heap, AFlatThingLiesMoreThanItStands) {
  Mesh mesh = icosphere(3);
  mesh.vertices.col(1) *= 0.3;
  const SurfaceTree disc(mesh);
  double height = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) height += heap({&disc}, kGap, seed)[0].translation.z() / 20;
  EXPECT_GT(height, 0.3);
  EXPECT_LT(height, 0.6) << "standing on its rim it would be 1, turned anyhow 0.78";
}

TEST(Heap, DependsOnTheSeedAlone) {
  const std::vector<SurfaceTree> surfaces = things();
  const PosedSurfaces one = heaped(surfaces, 1), again = heaped(surfaces, 1), other = heaped(surfaces, 2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].world_from_mesh.rotation, again[i].world_from_mesh.rotation);
    EXPECT_EQ(one[i].world_from_mesh.translation, again[i].world_from_mesh.translation);
    EXPECT_NE(one[i].world_from_mesh.rotation, other[i].world_from_mesh.rotation);
  }
}

TEST(Heap, OfNothingIsEmptyAndWithoutAGapRefused) {
  EXPECT_TRUE(heap({}, kGap, 1).empty());
  const SurfaceTree ball(icosphere(1));
  EXPECT_THROW(heap({&ball}, 0, 1), InvalidInput);
  EXPECT_THROW(heap({&ball}, std::numeric_limits<double>::quiet_NaN(), 1), InvalidInput);
}

}  // namespace
}  // namespace corral
