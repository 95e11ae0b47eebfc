// SPDX-License-Identifier: MIT
#include "grouping/pose/triple_filter.h"

#include <gtest/gtest.h>

#include "grouping/columns/filter_loops.h"
#include "grouping/pose/triple_sampler.h"
#include "tests/support/execution.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::available_targets;
using testing::ForcedTarget;
using testing::synthetic;

constexpr double kTolerancePr = 5, kAreaPr2 = 1e-3;

CorrespondenceSet stretched(CorrespondenceSet matches, const Eigen::Vector3d& factors) {
  matches.source_points *= factors.asDiagonal();
  matches.target_points *= factors.asDiagonal();
  return matches;
}

/// Also thin ones, tiny ones, far from the origin, and so large that small triangles are out of proportion.
std::vector<CorrespondenceSet> tables() {
  std::vector<CorrespondenceSet> all;
  for (const int rows : {3, 16, 33, 150})
    for (const double ratio : {0.1, 0.6, 1.0}) all.push_back(synthetic(rows, ratio, 3).matches);
  all.push_back(testing::harsh_table(150, 0.5, 4));
  all.push_back(stretched(synthetic(150, 0.7, 5).matches, {1, 1e-2, 1e-2}));
  all.push_back(stretched(synthetic(150, 0.7, 5).matches, {1, 1, 1e-3}));
  for (const double factor : {1e-3, 20.0, 1e4})
    all.push_back(stretched(synthetic(150, 0.7, 6).matches, {factor, factor, factor}));
  for (const double factor : {1e-90, 1e90}) all.push_back(testing::scaled(synthetic(60, 0.7, 6).matches, factor));
  CorrespondenceSet far = synthetic(150, 0.7, 7).matches;
  far.source_points.array() += 1e7;
  far.target_points.array() -= 3e6;
  all.push_back(far);
  return all;
}

int agreeing(const CorrespondenceSet& matches, const RigidTransform& pose) {
  int count = 0;
  for (int row = 0; row < matches.size(); ++row)
    count += (pose * matches.source_points.row(row).transpose() - matches.target_points.row(row).transpose()).norm() <
             kTolerancePr * matches.resolution;
  return count;
}

/// Rows whose residual on this axis is at most so many units.
int near_plane(const CorrespondenceSet& matches, const RigidTransform& pose, int axis, double most) {
  const Points residuals = pose.apply(matches.source_points) - matches.target_points;
  return static_cast<int>((residuals.col(axis).array().abs() <= most).count());
}

/// Sixteen triples with their motions.
struct Sixteen {
  LaneTriangles source[2], target[2];
  LaneMotions motions[2];

  Sixteen(const CorrespondenceSet& matches, RandomStream& random) {
    const UniformSampler sampler(matches.size());
    for (int k = 0; k < kFloatLanes; ++k) {
      const Triple triple = sampler.draw(random);
      source[k / kLanes].set(k % kLanes, matches.source_points, triple);
      target[k / kLanes].set(k % kLanes, matches.target_points, triple);
    }
    for (int half = 0; half < 2; ++half)
      fit_triangles(source[half], target[half], kAreaPr2 * matches.resolution * matches.resolution, motions[half]);
  }
};

TEST(TripleFilter, NoTripleWithEnoughRowsIsDropped) {
  int dropped = 0, usable = 0, ended = 0;
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    int number = 0;
    for (const CorrespondenceSet& matches : tables()) {
      SCOPED_TRACE(testing::target_name(each) + ", table " + std::to_string(number++));
      const FilterTable table(matches);
      const double tolerance = kTolerancePr * matches.resolution;
      TripleFilter filter(table, tolerance, kAreaPr2 * matches.resolution * matches.resolution);
      RandomStream random(8);
      for (int round = 0; round < 20 && filter.is_sharp(); ++round) {
        const Sixteen drawn(matches, random);
        for (int half = 0; half < 2; ++half) filter.set(drawn.source[half], drawn.target[half], half * kLanes);
        for (int k = 0; k < kFloatLanes; ++k) {
          if (!drawn.motions[k / kLanes].is_usable(k % kLanes)) continue;
          const int count = agreeing(matches, drawn.motions[k / kLanes].get(k % kLanes));
          const LaneFilters filters(table, drawn.motions[k / kLanes], tolerance);
          for (const int looked_at : {4, matches.size()}) {
            EXPECT_TRUE(filter.possible(table, count - 1, looked_at) >> k & 1);
            Slab slab = filter.slab(k);
            EXPECT_GE(slab.most, count);
            ended += slab.most < matches.size() / 2;
            slab.within = filters.within[k % kLanes];
            EXPECT_GE(count_near(table, filters.get(k % kLanes), slab, count - 1), count);
            dropped += (filter.possible(table, matches.size() / 2, looked_at) >> k & 1) == 0;
          }
          filter.possible(table, -1, matches.size());
          EXPECT_GE(filter.slab(k).most,
                    near_plane(matches, drawn.motions[k / kLanes].get(k % kLanes), filter.slab(k).axis,
                               0.9999 * table.unit() * static_cast<double>(filters.within[k % kLanes])));
          ++usable;
        }
      }
    }
  }
  EXPECT_GT(dropped, usable / 4);
  EXPECT_GT(ended, usable / 4);
}

TEST(TripleFilter, IsNotSharpWhereTheExtentIsOutOfProportion) {
  const CorrespondenceSet matches = synthetic(50, 0.5, 1).matches;
  EXPECT_TRUE(TripleFilter(FilterTable(matches), 5, 1e-3).is_sharp());
  EXPECT_FALSE(TripleFilter(FilterTable(matches), 5, 1e-9).is_sharp());
  EXPECT_FALSE(TripleFilter(FilterTable(testing::scaled(matches, 1e-80)), 5e-80, 1e-163).is_sharp());
}

TEST(LaneFilters, AreThoseOfTheirPoses) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    for (const CorrespondenceSet& matches : tables()) {
      const FilterTable table(matches);
      const double tolerance = kTolerancePr * matches.resolution;
      RandomStream random(9);
      const Sixteen drawn(matches, random);
      const LaneFilters filters(table, drawn.motions[1], tolerance);
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!drawn.motions[1].is_usable(lane)) continue;
        const RigidTransform pose = drawn.motions[1].get(lane);
        const int alone = count_near(table, PoseFilter(table, pose, tolerance), -1);
        const int together = count_near(table, filters.get(lane), -1);
        EXPECT_GE(together, agreeing(matches, pose));
        EXPECT_LE(std::abs(together - alone), 2);
      }
    }
  }
}

}  // namespace
}  // namespace corral
