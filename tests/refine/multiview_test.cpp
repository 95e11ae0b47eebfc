// SPDX-License-Identifier: MIT
#include "refine/multiview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::refusal_of;

constexpr double kResolution = 0.5;

/// Views of one object, each in coordinates of its own, and the poses between them.
struct Scene {
  std::vector<View> views;
  std::vector<RigidTransform> world_from_view;
  std::vector<ViewPair> pairs;
  std::vector<bool> is_wrong;  ///< by pair

  RigidTransform truth(int a, int b) const {
    return world_from_view[static_cast<std::size_t>(b)].inverse() * world_from_view[static_cast<std::size_t>(a)];
  }
  void add_pair(int a, int b, const RigidTransform& b_from_a, bool wrong) {
    pairs.push_back({a, b, b_from_a, 1});
    is_wrong.push_back(wrong);
  }
};

/// A small random motion: an angle in degrees about any axis, and a shift in pr about the center.
RigidTransform nudged(const RigidTransform& motion, const View& view, double degrees, double shift_pr,
                      RandomStream& random) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(degrees * random.normal() / 180 * 3.141592653589793, random.direction()).toRotationMatrix();
  RigidTransform moved{motion.rotation * turn, {}};
  moved.translation = motion * view.center - moved.rotation * view.center +
                      shift_pr * kResolution * random.normal() * random.direction();
  return moved;
}

Scene scene_without_pairs(int views, RandomStream& random) {
  Scene scene;
  for (int i = 0; i < views; ++i) {
    scene.world_from_view.push_back({random.rotation(), 300 * random.direction()});
    // Each sees a part of an object of radius 50 about the origin of the world.
    scene.views.push_back({scene.world_from_view.back().inverse() * (20 * random.direction()), 40});
  }
  return scene;
}

/// Every pair of neighbours on a ring up to `reach` apart, with noise; of a share of them the pose is any.
Scene ring(int views, int reach, double wrong_share, double degrees, double shift_pr, std::uint64_t seed) {
  RandomStream random(seed);
  Scene scene = scene_without_pairs(views, random);
  for (int a = 0; a < views; ++a)
    for (int step = 1; step <= reach; ++step) {
      const int b = (a + step) % views;
      const bool wrong = random.uniform() < wrong_share;
      const View& view = scene.views[static_cast<std::size_t>(a)];
      scene.add_pair(a, b,
                     wrong ? RigidTransform{random.rotation(), 300 * random.direction()}
                           : nudged(scene.truth(a, b), view, degrees, shift_pr, random),
                     wrong);
    }
  return scene;
}

/// How far the alignment moves the points of a view, beside the truth, both seen from view 0; root mean square in pr.
double error_pr(const Scene& scene, const MultiviewAlignment& aligned, int view) {
  const auto i = static_cast<std::size_t>(view);
  const RigidTransform found = aligned.world_from_view[0].inverse() * aligned.world_from_view[i],
                       truth = scene.truth(view, 0);
  const double turn = rotation_error_deg(found, truth) / 180 * 3.141592653589793;
  return std::hypot(scene.views[i].radius * turn,
                    (found * scene.views[i].center - truth * scene.views[i].center).norm()) /
         kResolution;
}

TEST(AlignViews, ExactPairsGiveTheExactAlignment) {
  const Scene scene = ring(8, 2, 0, 0, 0, 1);
  const MultiviewAlignment aligned = align_views(scene.views, scene.pairs, kResolution);
  EXPECT_TRUE(aligned.converged);
  for (int view = 0; view < 8; ++view) EXPECT_LT(error_pr(scene, aligned, view), 1e-8) << view;
  for (const PairJudgement& pair : aligned.pairs) {
    EXPECT_EQ(pair.verdict, PairVerdict::Agrees);
    EXPECT_LT(pair.error_pr, 1e-8);
    EXPECT_EQ(pair.loops, pair.closed_loops);
    EXPECT_GT(pair.loops, 0);
  }
  EXPECT_TRUE(aligned.world_from_view[0].rotation.isIdentity(1e-15));
}

TEST(AlignViews, NamesEveryWrongPairOfFive) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = ring(16, 4, 0.2, 0.15, 0.4, seed);
    const MultiviewAlignment aligned = align_views(scene.views, scene.pairs, kResolution);
    for (std::size_t i = 0; i < scene.pairs.size(); ++i)
      EXPECT_EQ(aligned.pairs[i].verdict == PairVerdict::Contradicts, scene.is_wrong[i])
          << "seed " << seed << " pair " << i;
    for (int view = 0; view < 16; ++view) EXPECT_LT(error_pr(scene, aligned, view), 1) << "seed " << seed;
  }
}

TEST(AlignViews, WhereNoThreeViewsArePairedTheTreeOfMostAgreementLeads) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream random(seed);
    Scene scene = scene_without_pairs(16, random);  // the corners of a cube of four dimensions, paired along its edges
    for (int a = 0; a < 16; ++a)
      for (int bit = 1; bit < 16; bit *= 2)
        if (a < (a ^ bit)) scene.add_pair(a, a ^ bit, scene.truth(a, a ^ bit), false);
    for (const std::size_t i : {0U, 13U, 21U}) {  // the first among them: nothing else tells them apart
      scene.pairs[i].b_from_a = {random.rotation(), 300 * random.direction()};
      scene.is_wrong[i] = true;
    }
    const MultiviewAlignment aligned = align_views(scene.views, scene.pairs, kResolution);
    for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
      EXPECT_EQ(aligned.pairs[i].loops, 0);
      EXPECT_EQ(aligned.pairs[i].verdict == PairVerdict::Contradicts, scene.is_wrong[i])
          << "seed " << seed << " pair " << i;
    }
  }
}

TEST(AlignViews, ManyPairsAreBetterThanATree) {
  double of_all = 0, of_tree = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene = ring(16, 4, 0, 0.1, 0.3, seed);
    const MultiviewAlignment all = align_views(scene.views, scene.pairs, kResolution);
    std::vector<ViewPair> chain;
    for (const ViewPair& pair : scene.pairs)
      if (pair.b == pair.a + 1) chain.push_back(pair);
    const MultiviewAlignment tree = align_views(scene.views, chain, kResolution);
    for (int view = 0; view < 16; ++view) of_all += error_pr(scene, all, view), of_tree += error_pr(scene, tree, view);
  }
  EXPECT_LT(of_all, 0.6 * of_tree);
}

TEST(AlignViews, ABridgeIsUncheckedAndFollowed) {
  Scene scene = ring(5, 2, 0, 0, 0, 2);
  RandomStream random(3);
  scene.world_from_view.push_back({random.rotation(), 10 * random.direction()});
  scene.views.push_back({Eigen::Vector3d(1, 2, 3), 40});
  scene.add_pair(5, 2, scene.truth(5, 2), false);
  const MultiviewAlignment aligned = align_views(scene.views, scene.pairs, kResolution);
  EXPECT_EQ(aligned.pairs.back().verdict, PairVerdict::Unchecked);
  EXPECT_EQ(aligned.pairs.back().loops, 0);
  EXPECT_EQ(aligned.pairs.front().verdict, PairVerdict::Agrees);
  EXPECT_LT(error_pr(scene, aligned, 5), 1e-8);
}

TEST(AlignViews, PartsThatNothingConnects) {
  Scene scene = ring(3, 1, 0, 0, 0, 4);
  for (int i = 0; i < 3; ++i) scene.views.push_back({Eigen::Vector3d::Zero(), 1});
  RigidTransform shift;
  shift.translation = Eigen::Vector3d(1, 2, 3);
  scene.pairs.push_back({3, 5, shift, 1});
  const MultiviewAlignment aligned = align_views(scene.views, scene.pairs, kResolution);
  EXPECT_THAT(aligned.part, ElementsAre(0, 0, 0, 1, 2, 1));
  EXPECT_TRUE(aligned.world_from_view[3].translation.isZero(0));
  EXPECT_TRUE(aligned.world_from_view[4].rotation.isIdentity(0));
  EXPECT_TRUE(aligned.world_from_view[5].translation.isApprox(Eigen::Vector3d(-1, -2, -3), 1e-12));
}

TEST(AlignViews, NoViewsAndNoPairs) {
  EXPECT_TRUE(align_views({}, {}, 1).world_from_view.empty());
  EXPECT_THAT(align_views({{}, {}}, {}, 1).part, ElementsAre(0, 1));
}

TEST(AlignViews, TheWeightOfAPairCounts) {
  // Two pairs between two views that differ by a little: the answer lies between them, nearer to the heavier.
  const std::vector<View> views(2);
  RigidTransform near, far;
  far.translation = Eigen::Vector3d(0.2, 0, 0);
  for (const double weight : {1.0, 9.0}) {
    const auto aligned = align_views(views, {{1, 0, near, 1}, {1, 0, far, weight}}, 1);
    EXPECT_NEAR(aligned.world_from_view[1].translation.x(), 0.2 * weight / (1 + weight), 1e-3);
  }
}

TEST(AlignViews, SameInputSameBytes) {
  const Scene scene = ring(10, 3, 0.2, 0.2, 0.5, 6);
  const MultiviewAlignment one = align_views(scene.views, scene.pairs, kResolution),
                           two = align_views(scene.views, scene.pairs, kResolution);
  for (std::size_t i = 0; i < one.world_from_view.size(); ++i) {
    EXPECT_EQ(one.world_from_view[i].rotation, two.world_from_view[i].rotation);
    EXPECT_EQ(one.world_from_view[i].translation, two.world_from_view[i].translation);
  }
}

TEST(AlignViews, WhatIsWrongIsNamed) {
  const Scene scene = ring(4, 1, 0, 0, 0, 1);
  const auto refusal = [&](const auto& spoil) {
    std::vector<View> views = scene.views;
    std::vector<ViewPair> pairs = scene.pairs;
    MultiviewOptions options;
    spoil(views, pairs, options);
    return refusal_of([&] { align_views(views, pairs, kResolution, options); });
  };
  EXPECT_THAT(refusal([](auto&, auto& pairs, auto&) { pairs[1].b = 4; }), HasSubstr("view of pair 1"));
  EXPECT_THAT(refusal([](auto&, auto& pairs, auto&) { pairs[2].b = pairs[2].a; }), HasSubstr("pair 2"));
  EXPECT_THAT(refusal([](auto&, auto& pairs, auto&) { pairs[0].weight = 0; }), HasSubstr("weight of pair 0"));
  EXPECT_THAT(refusal([](auto&, auto& pairs, auto&) { pairs[3].b_from_a.rotation *= 2; }), HasSubstr("pose of pair 3"));
  EXPECT_THAT(refusal([](auto& views, auto&, auto&) { views[2].radius = -1; }), HasSubstr("radius of view 2"));
  EXPECT_THAT(refusal([](auto& views, auto&, auto&) { views[1].center(0) = NAN; }), HasSubstr("center of view 1"));
  EXPECT_THAT(refusal([](auto&, auto&, auto& options) { options.limit_pr = NAN; }), HasSubstr("limit_pr"));
  EXPECT_THAT(refusal([](auto&, auto&, auto& options) { options.maximum_iterations = 0; }),
              HasSubstr("maximum_iterations"));
}

TEST(ViewOf, MeanAndSpread) {
  const View view = view_of(testing::points_of({{1, 0, 0}, {5, 0, 0}}));
  EXPECT_EQ(view.center, Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(view.radius, 2);
  EXPECT_THAT(refusal_of([] { view_of(Points(0, 3)); }), HasSubstr("view_of"));
  EXPECT_THAT(refusal_of([] { view_of(testing::points_of({{1, 1, 1}, {1, 1, 1}})); }), HasSubstr("one place"));
}

}  // namespace
}  // namespace corral
