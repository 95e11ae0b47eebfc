// SPDX-License-Identifier: MIT
#include "grouping/pose/triple_sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "grouping/columns/compatibility.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

bool is_distinct(const Triple& triple) { return std::set<int>(triple.begin(), triple.end()).size() == 3; }

TEST(TripleSampler, EveryOrderedTripleIsAsLikely) {
  RandomStream random(1);
  std::map<Triple, int> counts;
  for (int draw = 0; draw < 60000; ++draw) ++counts[UniformSampler(5).draw(random)];
  EXPECT_EQ(counts.size(), 60U);
  for (const auto& [triple, count] : counts) {
    EXPECT_TRUE(is_distinct(triple));
    EXPECT_NEAR(count, 1000, 150);  // five deviations
  }
}

TEST(TripleSampler, CompatibleTriplesKeepTheirDistancesFarMoreOften) {
  const CorrespondenceSet matches = testing::synthetic(300, 0.2, 1).matches;
  RandomStream random(2);
  const auto rigid = [&](const Triple& triple) {
    for (std::size_t i = 0; i < 3; ++i) {
      const PairDistances edge = pair_distances(matches, triple[i], triple[(i + 1) % 3]);
      if (!(std::abs(edge.source - edge.target) < 5)) return false;
    }
    return true;
  };
  int uniform = 0, compatible = 0;
  for (int draw = 0; draw < 2000; ++draw) {
    const Triple triple = draw_compatible_triple(random, matches, 5);
    EXPECT_TRUE(is_distinct(triple));
    compatible += rigid(triple);
    uniform += rigid(UniformSampler(matches.size()).draw(random));
  }
  EXPECT_GT(compatible, 5 * uniform);
}

/// By 1 - d1/d2 the rows are 4, 2, 0, 1, 3.
CorrespondenceSet five_rows() {
  CorrespondenceSet matches = testing::full_table(5);
  matches.feature_distance = testing::column_of({0.3, 0.3, 0.2, 0.4, 0.1});
  matches.second_feature_distance = testing::column_of({1, 1, 1, 1, 1});
  return matches;
}

TEST(ProgressiveSampler, BeginsWithTheBestAndTakesOneMoreAtATime) {
  // T_3 = 100 3!/(5 4 3) = 10, T_4 = 10 4/1 = 40, T_5 = 40 5/2 = 100: T' = 1, 31, 91.
  ProgressiveSampler sampler(five_rows(), 100);
  RandomStream random(3);
  EXPECT_THAT(sampler.draw(random), UnorderedElementsAre(4, 2, 0));
  for (int drawn = 2; drawn <= 31; ++drawn) {
    const Triple triple = sampler.draw(random);
    EXPECT_EQ(triple[2], 1);
    EXPECT_TRUE(is_distinct(triple));
    EXPECT_EQ(std::count(triple.begin(), triple.end(), 3), 0);
  }
  for (int drawn = 32; drawn <= 91; ++drawn) EXPECT_EQ(sampler.draw(random)[2], 3);
  std::set<int> last;
  for (int drawn = 92; drawn <= 200; ++drawn) last.insert(sampler.draw(random)[2]);
  EXPECT_THAT(last, ElementsAre(0, 1, 2, 3, 4));
}

TEST(ProgressiveSampler, ThreeRowsAreAlwaysTheTriple) {
  CorrespondenceSet matches = select_rows(five_rows(), {0, 1, 2});
  ProgressiveSampler sampler(matches, 10);
  RandomStream random(4);
  for (int draw = 0; draw < 20; ++draw) EXPECT_THAT(sampler.draw(random), UnorderedElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace corral
