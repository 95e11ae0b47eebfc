// SPDX-License-Identifier: MIT
// What floats call certain must be so in double, what is so in double they must call possible, and they must leave little
// undecided.
#include "grouping/columns/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "kernel/random.h"
#include "tests/support/execution.h"
#include "tests/support/table_changes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::available_targets;
using testing::ForcedTarget;
using testing::harsh_table;
using testing::scaled;
using testing::synthetic;
using testing::target_name;

/// Far from the origin, tiny, huge, with outliers, of one place, beyond what floats hold.
std::vector<CorrespondenceSet> tables() {
  std::vector<CorrespondenceSet> all;
  for (const int rows : {1, 15, 16, 17, 100}) all.push_back(synthetic(rows, 0.5, 3).matches);
  all.push_back(harsh_table(150, 0.3, 4));
  CorrespondenceSet far = synthetic(100, 0.5, 5).matches;
  far.source_points.array() += 1e7;
  far.target_points.array() -= 3e8;
  all.push_back(far);
  far.source_points.array() += 3e15;  // where doubles round residuals to halves
  far.target_points.array() -= 2e15;
  all.push_back(far);
  for (const double factor : {1e-30, 1e30, 1e-140, 1e-170, 1e200})
    all.push_back(scaled(synthetic(60, 0.5, 6).matches, factor));
  CorrespondenceSet outlier = synthetic(60, 0.5, 7).matches;
  outlier.target_points(3, 0) = 1e9;
  all.push_back(outlier);
  CorrespondenceSet one_place = synthetic(20, 0.5, 8).matches;
  one_place.source_points.rowwise() = one_place.source_points.row(0).eval();
  all.push_back(one_place);
  one_place.target_points.rowwise() = one_place.target_points.row(0).eval();
  all.push_back(one_place);
  return all;
}

template <class Check>
void on_every_target_and_table(Check check) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    int number = 0;
    for (const CorrespondenceSet& matches : tables()) {
      SCOPED_TRACE(target_name(each) + ", table " + std::to_string(number++));
      check(matches);
    }
  }
}

TEST(Filter, DistancesAreWithinTheBound) {
  on_every_target_and_table([](const CorrespondenceSet& matches) {
    const FilterTable table(matches);
    if (table.is_blind()) return;
    FloatColumn squared(static_cast<std::size_t>(table.padded_rows()));
    for (int i = 0; i < matches.size(); ++i) {
      measure_distances(table, i, squared.data());
      for (int j = 0; j < matches.size(); ++j) {
        if (i == j) continue;
        const double expected = point_distance(matches.source_points, i, j) / table.unit();
        EXPECT_LE(std::abs(std::sqrt(static_cast<double>(squared[static_cast<std::size_t>(j)])) - expected),
                  kFilterDistanceError);
      }
    }
  });
}

TEST(Filter, CountsOfConsistentRowsAreNeverTooSmallAndHardlyTooLarge) {
  int exact = 0, counted = 0;
  on_every_target_and_table([&](const CorrespondenceSet& matches) {
    const FilterTable table(matches);
    for (const double tolerance_pr : {1e-6, 3.0, 1e9}) {
      const double tolerance = tolerance_pr * matches.resolution;
      const ConsistencyFilter filter(table, tolerance);
      Indices counts(static_cast<std::size_t>(filter.padded_rows()));
      count_consistent(filter, counts.data());
      for (int i = 0; i < matches.size(); ++i) {
        int expected = 0;
        for (int j = 0; j < matches.size(); ++j) {
          const PairDistances distances = pair_distances(matches, i, j);
          expected += std::abs(distances.source - distances.target) < tolerance;
        }
        const int found = counts[static_cast<std::size_t>(i)];
        EXPECT_GE(found, expected);
        if (tolerance_pr == 3 && !table.is_blind() && table.unit() < 1e4 * matches.resolution)
          exact += found == expected, ++counted;
      }
    }
  });
  EXPECT_GT(exact, 0.99 * counted);
  EXPECT_GT(counted, 500);
}

TEST(Filter, RatiosAreBracketed) {
  int decided = 0, asked = 0;
  on_every_target_and_table([&](const CorrespondenceSet& matches) {
    const FilterTable table(matches);
    const auto size = static_cast<std::size_t>(table.padded_rows());
    for (const double similarity : {1e-9, 0.6, 0.9, 1.0}) {
      for (int block = 0; block < (matches.size() + 7) / 8; ++block) {
        std::vector<std::uint8_t> certain(size), possible(size);
        compare_ratios(table, SimilarityFilter(similarity), block, certain.data(), possible.data());
        for (int row = 0; row < table.padded_rows(); ++row)
          for (int bit = 0; bit < 8; ++bit) {
            const int column = 8 * block + bit;
            const bool is_certain = certain[static_cast<std::size_t>(row)] >> bit & 1;
            const bool is_possible = possible[static_cast<std::size_t>(row)] >> bit & 1;
            bool expected = false;
            if (row < matches.size() && column < matches.size()) {
              const PairDistances distances = pair_distances(matches, row, column);
              expected = rigidity_ratio(distances.source, distances.target) >= similarity;
              if (row != column && similarity == 0.6 && matches.resolution == 1 && table.unit() < 1e4)
                decided += is_certain == is_possible, ++asked;
            } else {
              EXPECT_FALSE(is_possible) << row << " " << column;
            }
            EXPECT_LE(is_certain, expected) << row << " " << column;
            EXPECT_LE(expected, is_possible) << row << " " << column;
          }
      }
    }
  });
  EXPECT_GT(decided, 0.97 * asked);
  EXPECT_GT(asked, 50000);
}

TEST(Filter, ResidualsAreBracketed) {
  on_every_target_and_table([](const CorrespondenceSet& matches) {
    const FilterTable table(matches);
    RandomStream random(9);
    for (int pose_number = 0; pose_number < 20; ++pose_number) {
      RigidTransform pose{random.rotation(), Eigen::Vector3d::Zero()};
      if (pose_number % 4 > 0)  // through a match; else, as one form of SI has it, about the origin
        pose.translation = (matches.target_points.row(pose_number % matches.size()) -
                            matches.source_points.row(pose_number % matches.size()) * pose.rotation.transpose())
                               .transpose();
      for (const double tolerance_pr : {1e-9, 5.0, 60.0, 1e12}) {
        const double tolerance = tolerance_pr * matches.resolution;
        const PoseFilter filter(table, pose, tolerance);
        int expected = 0;
        for (int row = 0; row < matches.size(); ++row)
          expected +=
              (pose * matches.source_points.row(row).transpose() - matches.target_points.row(row).transpose()).norm() <
              tolerance;
        const PoseFilter poses[kPoseTile] = {filter, filter, filter, filter};
        const int near = count_near(table, filter, -1);
        EXPECT_GE(near, expected);
        int in_parts[kPoseTile] = {};
        add_near(table, 0, kFloatLanes, poses, in_parts);
        EXPECT_LE(in_parts[0], near);
        add_near(table, kFloatLanes, table.padded_rows(), poses, in_parts);
        EXPECT_EQ(in_parts[0], in_parts[kPoseTile - 1]);
        EXPECT_EQ(in_parts[0], near);
        for (const int hopeless : {0, expected - 1, expected, expected + 3}) {
          const int stopped = count_near(table, filter, hopeless);
          EXPECT_EQ(stopped <= hopeless, near <= hopeless);
          EXPECT_EQ(std::max(stopped, hopeless), std::max(near, hopeless));
        }
        const FilteredVotes votes = ask_voters(table, SimilarityFilter(0), table, 0, filter);
        int agreeing = 0;
        for (int row = 0; row < matches.size(); ++row) {
          const PairDistances distances = pair_distances(matches, 0, row);
          agreeing +=
              rigidity_ratio(distances.source, distances.target) > 0 &&
              (pose * matches.source_points.row(row).transpose() - matches.target_points.row(row).transpose()).norm() <
                  tolerance;
        }
        EXPECT_LE(votes.certain, agreeing);
        EXPECT_GE(votes.possible, agreeing);
      }
    }
  });
}

TEST(Filter, AHiddenRowTakesNoPart) {
  const CorrespondenceSet matches = synthetic(20, 1, 1).matches;
  FilterTable table(matches);
  const PoseFilter all(table, {}, 1e9);
  EXPECT_EQ(ask_voters(table, SimilarityFilter(0.1), table, 4, all).possible, 20);
  const float hidden = table.hide(4);
  EXPECT_EQ(ask_voters(table, SimilarityFilter(0.1), table, 5, all).possible, 19);
  table.show(4, hidden);
  EXPECT_EQ(ask_voters(table, SimilarityFilter(0.1), table, 5, all).possible, 20);
}

TEST(Filter, ASubsetKeepsUnitAndRows) {
  const CorrespondenceSet matches = synthetic(20, 1, 1).matches;
  const FilterTable table(matches), some = table.subset({19, 3, 3});
  EXPECT_EQ(some.rows(), 3);
  EXPECT_EQ(some.unit(), table.unit());
  EXPECT_EQ(some.source(1)[0], table.source(1)[19]);
  EXPECT_EQ(some.target(2)[2], table.target(2)[3]);
  EXPECT_TRUE(std::isnan(some.source(0)[3]));
}

}  // namespace
}  // namespace corral
