// SPDX-License-Identifier: MIT
#include "apps/align/align_view_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "apps/runtime/workers.h"
#include "kernel/random.h"
#include "tests/support/object_views.h"

namespace corral {
namespace {

using testing::object_views;
using testing::ObjectViews;

constexpr int kViews = 9;
constexpr std::uint64_t kObject = 3;

/// Mean distance in pr between where two poses have the points of a view.
double apart_pr(const ViewSet& set, int view, const RigidTransform& one, const RigidTransform& other) {
  const Points& points = set.mesh(view).vertices;
  return (one.apply(points) - other.apply(points)).rowwise().norm().mean() / set.resolution();
}

/// The pose turned by half a turn about the middle of the points that it moves.
RigidTransform turned(const RigidTransform& pose, const Points& points) {
  const Eigen::Vector3d middle = points.colwise().mean().transpose();
  RigidTransform wrong{pose.rotation * Eigen::AngleAxisd(3, Eigen::Vector3d(1, 2, 3).normalized()), {}};
  wrong.translation = pose * middle - wrong.rotation * middle;
  return wrong;
}

TEST(AlignViewSet, ViewsFromAllAroundFindTheirPlaces) {
  const ObjectViews object = object_views(kViews, kObject);
  const ViewSet set(object.views, {}, workers(0));
  const AlignedViews aligned = align_view_set(set, {}, workers(0));
  EXPECT_TRUE(aligned.converged);
  EXPECT_EQ(*std::max_element(aligned.part.begin(), aligned.part.end()), 0);
  EXPECT_GE(aligned.pairs.size(), std::size_t{kViews});
  for (int a = 0; a < kViews; ++a)
    for (int b = 0; b < kViews; ++b)
      EXPECT_LT(apart_pr(set, a, aligned.between(a, b), object.between(a, b)), 1.5) << a << " " << b;
  int right = 0;
  for (const AlignedPair& pair : aligned.pairs) {
    const RigidTransform truth = object.between(pair.pose.a, pair.pose.b);
    const bool is_right = apart_pr(set, pair.pose.a, pair.pose.b_from_a, truth) < 3;
    EXPECT_EQ(pair.judgement.verdict, is_right ? PairVerdict::Agrees : PairVerdict::Contradicts)
        << pair.pose.a << " " << pair.pose.b;
    EXPECT_LE(pair.agreement.in_front, AlignOptions().most_in_front);
    EXPECT_GE(pair.agreement.overlap, AlignOptions().least_overlap);
    right += is_right;
  }
  EXPECT_GE(right, kViews + 5);
}

TEST(AlignViewSet, AnyNumberOfThreadsGivesTheSameBytes) {
  ObjectViews object = object_views(kViews, kObject);
  object.views.resize(4);
  const ViewSet one_thread(object.views, {}, one_by_one), set(object.views, {}, workers(3));
  const AlignedViews alone = align_view_set(one_thread, {}, one_by_one), aligned = align_view_set(set, {}, workers(3));
  ASSERT_EQ(alone.pairs.size(), aligned.pairs.size());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(alone.world_from_view[i].rotation, aligned.world_from_view[i].rotation);
    EXPECT_EQ(alone.world_from_view[i].translation, aligned.world_from_view[i].translation);
  }
}

TEST(AlignViewSet, TheSurfacesTellARightPoseFromAWrongOne) {
  const ObjectViews object = object_views(kViews, kObject);
  const ViewSet set(object.views, {}, workers(0));
  const RigidTransform truth = object.between(0, 1);
  const ViewAgreement right = set.agreement(0, 1, truth),
                      wrong = set.agreement(0, 1, turned(truth, set.mesh(0).vertices));
  EXPECT_GT(right.overlap, 0.4);
  EXPECT_LT(right.in_front, 0.005);
  EXPECT_LT(right.median_pr.value(), 0.8);
  EXPECT_GT(wrong.in_front, 0.02);
  const ViewAgreement nowhere = set.agreement(0, 1, {truth.rotation, Eigen::Vector3d(100, 0, 0)});
  EXPECT_EQ(nowhere.overlap, 0);
  EXPECT_FALSE(nowhere.median_pr);
}

TEST(AlignViewSet, EveryWrongPoseOfTheGivenOnesIsNamed) {
  const ObjectViews object = object_views(kViews, kObject);
  const ViewSet set(object.views, {}, workers(0));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RandomStream random(seed);
    std::vector<ViewPair> poses;
    std::vector<bool> is_wrong;
    for (int a = 0; a < kViews; ++a)
      for (int b = a + 1; b < kViews; ++b) {
        if (b - a > 2 && b - a < kViews - 2) continue;
        is_wrong.push_back(random.uniform() < 0.25);
        const RigidTransform truth = object.between(a, b);
        poses.push_back({a, b, is_wrong.back() ? turned(truth, set.mesh(a).vertices) : truth, 1});
      }
    const AlignedViews aligned = align_view_set(set, poses, {});
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(aligned.pairs[i].judgement.verdict == PairVerdict::Contradicts, is_wrong[i]) << seed << ": " << i;
  }
}

TEST(AlignViewSet, OfTwoPosesThatContradictTheSurfacesChoose) {
  // A ring that does not close, with one wrong pose in it: the loop alone cannot tell which.
  const ObjectViews object = object_views(kViews, kObject);
  const ViewSet set(object.views, {}, workers(0));
  for (int wrong = 0; wrong < 3; ++wrong) {
    std::vector<ViewPair> poses = {
        {0, 1, object.between(0, 1), 1}, {0, 2, object.between(0, 2), 1}, {1, 2, object.between(1, 2), 1}};
    ViewPair& spoilt = poses[static_cast<std::size_t>(wrong)];
    spoilt.b_from_a = turned(spoilt.b_from_a, set.mesh(spoilt.a).vertices);
    const AlignedViews aligned = align_view_set(set, poses, {});
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(aligned.pairs[static_cast<std::size_t>(i)].judgement.verdict == PairVerdict::Contradicts, i == wrong);
  }
}

TEST(AlignViewSet, ViewsOfAnotherObjectStayApart) {
  ObjectViews object = object_views(kViews, kObject);
  object.views.resize(3);
  const ObjectViews other = object_views(kViews, kObject + 4);
  object.views.push_back(other.views[0]);
  const ViewSet set(object.views, {}, workers(0));
  EXPECT_THAT(align_view_set(set, {}, workers(0)).part, ::testing::ElementsAre(0, 0, 0, 1));
}

}  // namespace
}  // namespace corral
