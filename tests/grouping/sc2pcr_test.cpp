// SPDX-License-Identifier: MIT
#include "grouping/sc2pcr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing::table_of_points;

void expect_nothing(const GroupingResult& result) {
  EXPECT_THAT(result.selected, IsEmpty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

Sc2pcrOptions raw() {
  Sc2pcrOptions options;
  options.refit_rounds = 0;
  return options;
}

/// Four corners that stay and one row that goes astray. v is 1/2 on the four; five rows have one seed, the first of them.
CorrespondenceSet corners_and_a_stray() {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                         {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
}

TEST(Sc2pcr, CornersThatStay) {
  for (const Sc2pcrOptions& options : {raw(), Sc2pcrOptions()}) {
    const GroupingResult result = group_by_sc2pcr(corners_and_a_stray(), options);
    EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
    ASSERT_TRUE(result.target_from_source.has_value());
    EXPECT_TRUE(result.target_from_source->rotation.isIdentity(1e-12));
    EXPECT_TRUE(result.target_from_source->translation.isZero(1e-12));
    EXPECT_THAT(result.scores, IsEmpty());
  }
}

TEST(Sc2pcr, FewerThanThreeThatAgreeAreNothing) {
  const CorrespondenceSet table = corners_and_a_stray();
  expect_nothing(group_by_sc2pcr(select_rows(table, {0, 1})));
  expect_nothing(group_by_sc2pcr(select_rows(table, {0, 1, 4})));
  EXPECT_THAT(group_by_sc2pcr(select_rows(table, {0, 1, 2})).selected, ElementsAre(0, 1, 2));
}

TEST(Sc2pcr, LinesGiveNoPose) {
  const std::vector<testing::Row3> line = {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}, {70, 0, 0}};
  expect_nothing(group_by_sc2pcr(table_of_points(line, line)));
}

/// One triangle whose third corner is off by `off` along its legs, so that it agrees with either leg while off < d.
CorrespondenceSet stretched(double off) {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}}, {{0, 0, 0}, {20, 0, 0}, {0, 20 + off, 0}});
}

TEST(Sc2pcr, DifferenceOfLengthsIsBelowTheDistance) {
  // D of the third row: 2.4 to the first, 1.745 to the second, which is the seed. It needs a close neighbour in common.
  Sc2pcrOptions options = raw();
  options.distance_pr = 2.4;
  expect_nothing(group_by_sc2pcr(stretched(2.4), options));
  options.distance_pr = 2.4 + 1e-9;
  expect_nothing(group_by_sc2pcr(stretched(2.4), options));  // W = 0
  options.distance_pr = 3.6;                                 // 1.745 < 1.8
  EXPECT_THAT(group_by_sc2pcr(stretched(2.4), options).selected, ElementsAre(0, 1, 2));
  CorrespondenceSet in_mm = stretched(2.4);
  in_mm.resolution = 2;  // of the default 5 pr half is 5
  EXPECT_THAT(group_by_sc2pcr(in_mm, raw()).selected, ElementsAre(0, 1, 2));
}

TEST(Sc2pcr, FarSeedsAreThereWhereTheShareAllowsThem) {
  // 40 and 20 rows, each moved in its own way, and 100 at random. The limit of v would be 0 on the 20.
  SyntheticOptions of_many, of_few, random;
  of_many.matches = 40, of_few.matches = 20, random.matches = 100;
  of_many.inlier_ratio = of_few.inlier_ratio = 1, random.inlier_ratio = 0;
  of_many.seed = 1, of_few.seed = 2, random.seed = 3;
  const SyntheticProblem many = make_synthetic_problem(of_many), few = make_synthetic_problem(of_few),
                         noise = make_synthetic_problem(random);
  CorrespondenceSet table;
  table.resolution = many.matches.resolution;
  table.source_points.resize(160, 3);
  table.target_points.resize(160, 3);
  table.source_points << many.matches.source_points, few.matches.source_points, noise.matches.source_points;
  table.target_points << many.matches.target_points, few.matches.target_points, noise.matches.target_points;
  Sc2pcrOptions options;
  options.keep = 3;
  options.seed_share = 1;  // by v, rows that agree with some of the 40 by chance come before the 20
  const GroupingResult found = group_by_sc2pcr(table, options);
  const auto error = [&](const RigidTransform& pose, const RigidTransform& truth) {
    return point_error(pose, truth, table.source_points, 1)->rmse_pr;
  };
  ASSERT_TRUE(found.target_from_source.has_value());
  EXPECT_LT(error(*found.target_from_source, many.truth), 2);
  ASSERT_FALSE(found.runner_up.empty());
  EXPECT_LT(error(found.runner_up[0].target_from_source, few.truth), 5);
  options.seed_share = 0.01;  // one seed
  EXPECT_THAT(group_by_sc2pcr(table, options).runner_up, IsEmpty());
  EXPECT_LT(error(*group_by_sc2pcr(table, options).target_from_source, many.truth), 2);
}

TEST(Sc2pcr, OneSeedWithinTheRadius) {
  // Three motions of four rows each; the first rows of each share a place. Within the radius of the whole table there is
  // one seed, so that there are no other poses to run up.
  std::vector<testing::Row3> source, target;
  const std::vector<testing::Row3> corners = {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}};
  for (int motion = 0; motion < 3; ++motion)
    for (const testing::Row3& corner : corners) {
      source.push_back({corner[0] + motion, corner[1], corner[2]});
      target.push_back({corner[0] + motion + 400.0 * motion * motion, corner[1] + 100 * motion, corner[2]});
    }
  const CorrespondenceSet table = table_of_points(source, target);
  Sc2pcrOptions options;
  options.keep = 5;
  options.seed_share = 1;
  options.seed_radius_pr = 1e-3;
  EXPECT_THAT(group_by_sc2pcr(table, options).runner_up, SizeIs(2));
  options.seed_radius_pr = 100;
  EXPECT_THAT(group_by_sc2pcr(table, options).runner_up, IsEmpty());
  EXPECT_THAT(group_by_sc2pcr(table, options).selected, SizeIs(4));
}

TEST(Sc2pcr, RefitImprovesThePose) {
  double raw_error = 0, error = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticProblem problem = testing::synthetic(300, 0.3, seed);
    const auto off = [&](const Sc2pcrOptions& options) {
      const auto pose = group_by_sc2pcr(problem.matches, options).target_from_source;
      return point_error(*pose, problem.truth, problem.matches.source_points, 1)->rmse_pr;
    };
    raw_error += off(raw());
    error += off({});
  }
  EXPECT_LT(error, raw_error);
}

}  // namespace
}  // namespace corral
