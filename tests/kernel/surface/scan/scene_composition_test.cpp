// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/scene_composition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

#include "kernel/error.h"
#include "kernel/surface/scan/heap.h"
#include "kernel/surface/scan/visibility.h"
#include "tests/support/execution.h"
#include "tests/support/scanned.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(VisibilityCounts, BinsHoldTheirLowerEdgeAndTheLastItsUpper) {
  VisibilityCounts counts;
  counts.add(0.60, 0.65);
  counts.add(0.649, 0.70);
  counts.add(0.85, 0.90);
  counts.add(0.95, 0.95);
  EXPECT_THAT(counts.occlusion, ElementsAre(2, 0, 0, 0, 0, 2));
  EXPECT_THAT(counts.clutter, ElementsAre(1, 1, 0, 0, 0, 2));
  EXPECT_EQ(counts.outside, 0);
  counts.add(0.599, 0.8);
  counts.add(0.8, 0.951);
  counts.add(0.8, 0.649);
  EXPECT_EQ(counts.outside, 3);
  EXPECT_EQ(std::accumulate(counts.occlusion.begin(), counts.occlusion.end(), 0), 4);
}

/// Six long, flat and knobbly things.
class Composition : public ::testing::Test {
 protected:
  Composition() {
    for (int i = 0; i < 6; ++i) {
      Mesh mesh = testing::bumpy_sphere(2, static_cast<std::uint64_t>(i));
      mesh.vertices.col(i % 3) *= 0.5;
      mesh.vertices.col((i + 1) % 3) *= i < 3 ? 0.6 : 1.0;
      surfaces_.emplace_back(mesh);
    }
    for (const SurfaceTree& surface : surfaces_) pointers_.push_back(&surface);
    options_.scenes = 2;
    options_.spacing = 0.05;
  }

  std::vector<SurfaceTree> surfaces_;
  std::vector<const SurfaceTree*> pointers_;
  CompositionOptions options_;
};

TEST_F(Composition, DifferentObjectsThatDoNotTouchBeforeASensor) {
  const std::vector<ComposedScene> scenes = compose_scenes(pointers_, options_);
  ASSERT_EQ(scenes.size(), 2U);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    EXPECT_EQ(scenes[i].objects.size(), i % 2 == 0 ? 4U : 5U);
    EXPECT_EQ(std::set<int>(scenes[i].objects.begin(), scenes[i].objects.end()).size(), scenes[i].objects.size());
    const PosedSurfaces posed = scenes[i].posed(pointers_);
    for (std::size_t a = 0; a < posed.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(touch(posed[a], posed[b]));
    EXPECT_GT(scan_range(posed, scenes[i].sensor, testing::with_spacing(0.06)).points.rows(), 500);
    const Eigen::Vector3d away = (scenes[i].sensor.position - scenes[i].sensor.target).normalized();
    EXPECT_GT(away.z(), 0.17) << "from above";
    EXPECT_LT(away.z(), 0.87);
  }
}

TEST_F(Composition, PairsSpreadOverTheBins) {
  options_.scenes = 12;
  VisibilityCounts counts;
  const std::vector<ComposedScene> scenes = compose_scenes(pointers_, options_, testing::on_three_threads);
  for (const ComposedScene& scene : scenes) {
    const PosedSurfaces posed = scene.posed(pointers_);
    for (const Visibility& pair :
         measure_visibility(posed, scan_range(posed, scene.sensor, testing::with_spacing(0.05))))
      counts.add(pair.occlusion, pair.clutter);
  }
  std::map<int, int> uses;
  std::set<double> sides;
  for (const ComposedScene& scene : scenes) {
    for (const int object : scene.objects) ++uses[object];
    sides.insert(scene.world_from_object[0].rotation(0, 0));
  }
  EXPECT_EQ(sides.size(), scenes.size()) << "a heap is seen once";
  EXPECT_EQ(uses.size(), 6U);
  for (const auto& [object, scenes_with] : uses) EXPECT_GE(scenes_with, 3) << object << ", in 9 scenes on average";
  EXPECT_LT(counts.outside, 12) << "of 54";
  for (const int pairs : counts.occlusion) EXPECT_GE(pairs, 3);
  for (const int pairs : counts.clutter) EXPECT_GE(pairs, 3);
}

TEST_F(Composition, TheSameOnAnyThreadsAndAnotherForAnotherSeed) {
  const auto expected = compose_scenes(pointers_, options_);
  const auto same = [&](const std::vector<ComposedScene>& scenes) {
    bool equal = scenes.size() == expected.size();
    for (std::size_t i = 0; equal && i < scenes.size(); ++i) {
      equal = scenes[i].objects == expected[i].objects && scenes[i].sensor.position == expected[i].sensor.position;
      for (std::size_t k = 0; equal && k < scenes[i].objects.size(); ++k)
        equal = scenes[i].world_from_object[k].rotation == expected[i].world_from_object[k].rotation &&
                scenes[i].world_from_object[k].translation == expected[i].world_from_object[k].translation;
    }
    return equal;
  };
  EXPECT_TRUE(same(compose_scenes(pointers_, options_, testing::on_three_threads)));
  EXPECT_TRUE(same(compose_scenes(pointers_, options_, testing::last_first)));
  options_.seed = 2;
  EXPECT_FALSE(same(compose_scenes(pointers_, options_)));
}

TEST_F(Composition, FewerObjectsThanASceneWantsAreAllThere) {
  options_.scenes = 1;
  EXPECT_EQ(compose_scenes({pointers_[0], pointers_[1]}, options_).front().objects.size(), 2U);
}

TEST_F(Composition, RefusesWhatNoSceneCanBeMadeOf) {
  EXPECT_THROW(compose_scenes({}, options_), InvalidInput);
  options_.scenes = 0;
  EXPECT_THROW(compose_scenes(pointers_, options_), InvalidInput);
  options_.scenes = 1, options_.least_objects = 6, options_.most_objects = 5;
  EXPECT_THROW(compose_scenes(pointers_, options_), InvalidInput);
  options_.least_objects = 1, options_.spacing = 0;
  EXPECT_THROW(compose_scenes(pointers_, options_), InvalidInput);
}

}  // namespace
}  // namespace corral
