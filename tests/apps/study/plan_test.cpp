// SPDX-License-Identifier: MIT
#include "apps/study/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kernel/random.h"

namespace corral {
namespace {

std::vector<UnitEstimate> random_estimates(int count) {
  RandomStream stream(3);
  std::vector<UnitEstimate> estimates;
  for (int i = 0; i < count; ++i) estimates.push_back({1 + stream.below(1000), 1 + stream.below(100)});
  return estimates;
}

std::uint64_t total(const std::vector<UnitEstimate>& estimates) {
  return std::accumulate(estimates.begin(), estimates.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const UnitEstimate& unit) { return sum + unit.microseconds; });
}

// Largest first, each to the emptiest: no shard exceeds an even share by more than its last unit.
TEST(Plan, IsBalanced) {
  const std::vector<UnitEstimate> estimates = random_estimates(500);
  for (const int shards : {1, 2, 7, 50}) {
    const std::vector<int> shard_of = split_units(estimates, shards);
    std::vector<std::uint64_t> loads(static_cast<std::size_t>(shards));
    for (std::size_t unit = 0; unit < shard_of.size(); ++unit) {
      ASSERT_GE(shard_of[unit], 1);
      ASSERT_LE(shard_of[unit], shards);
      loads[static_cast<std::size_t>(shard_of[unit] - 1)] += estimates[unit].microseconds;
    }
    const auto [least, most] = std::minmax_element(loads.begin(), loads.end());
    EXPECT_LE(*most, total(estimates) / static_cast<std::uint64_t>(shards) + 1000);
    EXPECT_LE(*most - *least, 1000u);
  }
}

TEST(Plan, TiesGoToTheFirstUnitAndTheFirstShard) {
  EXPECT_EQ(split_units({{5, 0}, {5, 0}, {5, 0}, {5, 0}}, 3), (std::vector<int>{1, 2, 3, 1}));
  EXPECT_EQ(split_units({{1, 0}, {9, 0}, {4, 0}, {4, 0}}, 2), (std::vector<int>{2, 1, 2, 2}));
}

TEST(Plan, RecordedTimesChangeTheSumsButNotTheSplit) {
  const std::vector<UnitEstimate> estimates = {{3'000'000, 10}, {2'000'000, 30}, {1'000'000, 20}};
  const auto estimated = plan_shards(estimates, 2), recorded = plan_shards(estimates, 2, {0.5, 7, 9});
  ASSERT_EQ(estimated.size(), 2u);
  EXPECT_EQ(estimated[0].seconds, 3);
  EXPECT_EQ(estimated[1].seconds, 3);
  EXPECT_EQ(estimated[1].pairs, 2);
  EXPECT_EQ(estimated[1].peak_bytes, 30) << "one pair at a time";
  EXPECT_EQ(recorded[0].seconds, 0.5);
  EXPECT_EQ(recorded[1].seconds, 16);
  EXPECT_EQ(recorded[1].pairs, 2);
}

TEST(Plan, ShardsWithoutAUnitAreEmpty) {
  const auto plan = plan_shards({{1, 1}}, 3);
  EXPECT_EQ(plan[0].pairs + plan[1].pairs + plan[2].pairs, 1);
}

}  // namespace
}  // namespace corral
