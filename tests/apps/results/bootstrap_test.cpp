// SPDX-License-Identifier: MIT
#include "apps/results/bootstrap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using Values = std::vector<double>;

TEST(Bootstrap, IsDeterministicAndHoldsItsMean) {
  const Values values = {0.1, 0.9, 0.4, 0.4, 0.8, 0.0, 0.3};
  const MeanInterval once = bootstrap_mean(values, 5), again = bootstrap_mean(values, 5);
  EXPECT_EQ(once.low, again.low);
  EXPECT_EQ(once.high, again.high);
  EXPECT_NE(once.low, bootstrap_mean(values, 6).low);
  EXPECT_NEAR(once.mean, 2.9 / 7, 1e-15);
  EXPECT_LT(once.low, once.mean);
  EXPECT_GT(once.high, once.mean);
  EXPECT_GE(once.low, 0);
  EXPECT_LE(once.high, 0.9);
  const MeanInterval single = bootstrap_mean({0.25}, 1), constant = bootstrap_mean(Values(8, 0.7), 1);
  EXPECT_THAT((Values{single.low, single.high}), ElementsAre(0.25, 0.25));
  EXPECT_EQ(constant.low, constant.high);
  const MeanInterval two = bootstrap_mean({0, 1}, 1);  // Student's quantile is 12.7: all that was resampled
  EXPECT_THAT((Values{two.low, two.high}), ElementsAre(0, 1));
  EXPECT_THROW(bootstrap_mean({}, 1), InvalidInput);
}

TEST(Bootstrap, LeansToTheLongTail) {
  const Values skewed = {0.02, 0.03, 0.01, 0.05, 0.04, 0.02, 0.06, 0.03, 0.5, 0.9};
  const MeanInterval interval = bootstrap_mean(skewed, 1);
  // the same formula in numpy with 1,000,000 resamples
  EXPECT_NEAR(interval.low, 0.031, 0.005);
  EXPECT_NEAR(interval.high, 0.509, 0.05);
  Values mirrored;
  for (const double value : skewed) mirrored.push_back(-value);
  const MeanInterval other = bootstrap_mean(mirrored, 1);
  EXPECT_NEAR(other.low, -interval.high, 1e-12);  // the same draws, mirrored
  EXPECT_NEAR(other.high, -interval.low, 1e-12);
}

TEST(Bootstrap, DrawsColumnsTogetherAsItDrawsThemAlone) {
  RandomStream stream(3);
  std::vector<Values> columns(6, Values(40));
  for (Values& column : columns)
    for (double& value : column) value = stream.uniform();
  columns[2].assign(40, 0.5);
  const std::vector<MeanInterval> together = bootstrap_means(columns, 9);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const MeanInterval alone = bootstrap_mean(columns[i], 9);
    EXPECT_EQ(together[i].mean, alone.mean) << i;
    EXPECT_EQ(together[i].low, alone.low) << i;
    EXPECT_EQ(together[i].high, alone.high) << i;
  }
  columns[5].pop_back();
  EXPECT_THROW(bootstrap_means(columns, 9), InvalidInput);
}

/// A variable in [0, 1] with density proportional to x^(a-1) (1-x)^(b-1), for whole a and b: an order statistic.
double beta(RandomStream& stream, int a, int b) {
  Values draws;
  for (int i = 0; i < a + b - 1; ++i) draws.push_back(stream.uniform());
  std::sort(draws.begin(), draws.end());
  return draws[static_cast<std::size_t>(a - 1)];
}

struct Study {
  const char* shape;
  double truth;
  std::function<double(RandomStream&)> draw;
};

/// Precisions and recalls as they occur: skewed to either side, empty selections, pairs that are solved or lost.
const std::vector<Study>& studies() {
  static const std::vector<Study> shapes = {
      {"good", 0.8, [](RandomStream& stream) { return beta(stream, 8, 2); }},
      {"poor", 2.0 / 7, [](RandomStream& stream) { return beta(stream, 2, 5); }},
      {"some empty", 0.8 * 4 / 6, [](RandomStream& stream) { return stream.uniform() < 0.2 ? 0 : beta(stream, 4, 2); }},
      {"solved or lost", 0.7 * 0.9 + 0.3 / 9,
       [](RandomStream& stream) { return stream.uniform() < 0.3 ? beta(stream, 1, 8) : beta(stream, 9, 1); }},
      {"difference of two", 0.8 - 2.0 / 7, [](RandomStream& stream) {
         const double first = beta(stream, 8, 2);
         return first - beta(stream, 2, 5);
       }}};
  return shapes;
}

TEST(Bootstrap, IntervalsCoverTheTruthInAsManyStudiesAsTheySay) {
  for (const Study& study : studies()) {
    RandomStream stream(derive_seed(11, study.shape));
    int covered = 0;
    for (int trial = 0; trial < 1000; ++trial) {
      Values values(10 + stream.below(21));  // 10 .. 30 pairs
      for (double& value : values) value = study.draw(stream);
      const MeanInterval interval = bootstrap_mean(values, static_cast<std::uint64_t>(trial));
      covered += interval.low <= study.truth && study.truth <= interval.high;
    }
    EXPECT_GE(covered, 930) << study.shape;
    EXPECT_LE(covered, 970) << study.shape;
  }
}

}  // namespace
}  // namespace corral
