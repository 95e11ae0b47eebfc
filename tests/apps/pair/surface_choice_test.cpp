// SPDX-License-Identifier: MIT
#include "apps/pair/surface_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

/// A ball without symmetry and its image, with rows that follow the truth and more that follow a wrong pose.
struct Case {
  Mesh source = testing::bumpy_sphere(3, 1), target = source;
  RigidTransform truth, wrong;
  CorrespondenceSet matches;

  Case() {
    truth.rotation = RandomStream(1).rotation();
    wrong.rotation = RandomStream(2).rotation();
    target.vertices = truth.apply(source.vertices);
    matches.resolution = 0.005;
    matches.source_points = source.vertices.topRows(30);
    matches.target_points.resize(30, 3);
    matches.target_points.topRows(10) = truth.apply(matches.source_points.topRows(10));
    matches.target_points.bottomRows(20) = wrong.apply(matches.source_points.bottomRows(20));
  }

  GroupingResult found(const RigidTransform& first, const RigidTransform& second) const {
    GroupingResult result;
    result.target_from_source = first;
    result.selected = {0, 1, 2};
    result.runner_up = {{second, 1}};
    return result;
  }
};

TEST(SurfaceChoice, TakesThePoseUnderWhichTheSurfacesLieOnEachOther) {
  const Case made;
  const SurfaceChoice choice(made.source, made.target);
  const GroupingResult chosen = choice(made.matches, made.found(made.wrong, made.truth));
  ASSERT_TRUE(chosen.target_from_source);
  EXPECT_LT(rotation_error_deg(*chosen.target_from_source, made.truth), 1e-6);
  EXPECT_THAT(chosen.selected, ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(SurfaceChoice, LeavesTheAnswerAloneWhereItIsTheBestOrTheOnlyOne) {
  const Case made;
  const SurfaceChoice choice(made.source, made.target);
  const GroupingResult right = made.found(made.truth, made.wrong);
  EXPECT_EQ(choice(made.matches, right).selected, right.selected);
  GroupingResult alone = made.found(made.wrong, made.truth);
  alone.runner_up.clear();
  EXPECT_EQ(choice(made.matches, alone).selected, alone.selected);
}

}  // namespace
}  // namespace corral
