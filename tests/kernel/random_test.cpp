// SPDX-License-Identifier: MIT
#include "kernel/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "kernel/rigid_transform.h"

namespace corral {
namespace {

/// Sum of (observed - expected)^2 / expected over equally likely classes.
double chi_square(const std::vector<int>& observed, int draws) {
  const double expected = static_cast<double>(draws) / static_cast<double>(observed.size());
  double sum = 0;
  for (const int count : observed) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

/// Mean of chi-square with so many classes plus five deviations.
double chi_square_limit(std::size_t classes) {
  const auto freedom = static_cast<double>(classes - 1);
  return freedom + 5 * std::sqrt(2 * freedom);
}

TEST(RandomStream, FirstDrawsAreFixed) {
  RandomStream random(1);
  for (const std::uint64_t expected : {3u, 0u, 274u, 682u}) EXPECT_EQ(random.below(1000), expected);
  EXPECT_EQ(random.uniform(), 0.11091316000070828);
  EXPECT_EQ(random.uniform(), 0.23053390694567755);
  // What goes through a logarithm or a sine may differ in the last digit from one mathematics library to another.
  EXPECT_NEAR(random.normal(), -0.36403105488307008, 1e-14);
  EXPECT_NEAR(random.normal(), 0.37015230297948443, 1e-14);
  EXPECT_NEAR(random.normal(), -0.91739855968857131, 1e-14);
  EXPECT_LT(
      (random.direction() - Eigen::Vector3d(0.29068451492323805, 0.69610963766166012, 0.65645554696292552)).norm(),
      1e-14);
  const Eigen::Matrix3d rotation = random.rotation();
  EXPECT_NEAR(rotation(0, 0), 0.90333307471978386, 1e-14);
  EXPECT_NEAR(rotation(2, 1), -0.52975004491533695, 1e-14);
  EXPECT_EQ(random.below(1000000), 227746u);  // every draw above took its fixed share of the stream
}

TEST(RandomStream, EngineIsThatOfTheStandard) {
  for (const std::uint64_t seed : {0ull, 1ull, 5489ull, ~0ull}) {
    MersenneTwister ours(seed);
    std::mt19937_64 standard(seed);
    for (int draw = 0; draw < 2000; ++draw) ASSERT_EQ(ours(), standard()) << seed << " " << draw;
  }
}

TEST(RandomStream, RemaindersAreThoseOfDivisions) {
  std::mt19937_64 words(1);
  const std::uint64_t most = ~std::uint64_t{0};
  const std::vector<std::uint64_t> counts = {1,        2,   3, 1000, 0xFFFFFFFF, 0x100000000, 0x8000000000000001,
                                             most - 1, most};
  for (const std::uint64_t count : counts) {
    const WholeRange range(count);
    for (const std::uint64_t word : {std::uint64_t{0}, count - 1, count, 2 * count - 1, most / count * count - 1,
                                     most / count * count, most - 1, most})
      EXPECT_EQ(range.remainder(word), word % count) << word << " " << count;
    for (int draw = 0; draw < 1000; ++draw) {
      const std::uint64_t word = words();
      ASSERT_EQ(range.remainder(word), word % count) << word << " " << count;
    }
  }
}

TEST(RandomStream, SeedDecides) {
  RandomStream a(1), b(1), c(2);
  int different = 0;
  for (int draw = 0; draw < 100; ++draw) {
    const double x = a.normal();
    EXPECT_EQ(x, b.normal());
    if (x != c.normal()) ++different;
  }
  EXPECT_EQ(different, 100);
}

TEST(RandomStream, UniformIsUniform) {
  RandomStream random(3);
  std::vector<int> counts(64, 0);
  double sum = 0, squares = 0, previous = 0.5, products = 0;
  for (int draw = 0; draw < 200000; ++draw) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    ASSERT_EQ(std::ldexp(x, 53), std::floor(std::ldexp(x, 53)));
    ++counts[static_cast<std::size_t>(64 * x)];
    sum += x;
    squares += x * x;
    products += (x - 0.5) * (previous - 0.5);
    previous = x;
  }
  EXPECT_LT(chi_square(counts, 200000), chi_square_limit(64));
  EXPECT_NEAR(sum / 200000, 0.5, 5 * std::sqrt(1.0 / 12 / 200000));
  EXPECT_NEAR(squares / 200000, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / 200000));
  EXPECT_NEAR(products / 200000, 0, 5 / 12.0 / std::sqrt(200000.0));
}

TEST(RandomStream, UniformBetweenStaysBetween) {
  RandomStream random(4);
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (int draw = 0; draw < 10000; ++draw) {
    const double x = random.uniform(-3, 5);
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
  }
  EXPECT_GE(lowest, -3);
  EXPECT_LT(lowest, -2.9);
  EXPECT_LT(highest, 5);
  EXPECT_GT(highest, 4.9);
}

TEST(RandomStream, BelowIsUniformForAwkwardCounts) {
  for (const std::uint64_t count : {1u, 2u, 3u, 5u, 6u, 7u, 10u, 97u, 1000u}) {
    RandomStream random(count);
    std::vector<int> counts(static_cast<std::size_t>(count), 0);
    for (int draw = 0; draw < 100000; ++draw) {
      const std::uint64_t x = random.below(count);
      ASSERT_LT(x, count);
      ++counts[static_cast<std::size_t>(x)];
    }
    if (count > 1) {
      EXPECT_LT(chi_square(counts, 100000), chi_square_limit(counts.size())) << count;
    }
  }
}

TEST(RandomStream, BelowHasNoBiasForHugeCounts) {
  // Of 3 * 2^62 values a third lies below 2^62; a remainder of 64 bits would put a half there.
  const std::uint64_t third = 1ULL << 62;
  RandomStream random(5);
  std::vector<int> counts(3, 0);
  for (int draw = 0; draw < 30000; ++draw) {
    const std::uint64_t x = random.below(3 * third);
    ASSERT_LT(x, 3 * third);
    ++counts[static_cast<std::size_t>(x / third)];
  }
  EXPECT_LT(chi_square(counts, 30000), chi_square_limit(3));
  const std::uint64_t half = (1ULL << 63) + 1;
  int in_lower = 0;
  for (int draw = 0; draw < 30000; ++draw) {
    const std::uint64_t x = random.below(half);
    ASSERT_LT(x, half);
    if (x < half / 2) ++in_lower;
  }
  EXPECT_NEAR(in_lower, 15000, 5 * std::sqrt(7500.0));
}

TEST(RandomStream, NormalHasItsMoments) {
  RandomStream random(6);
  const int draws = 200000;
  double first = 0, second = 0, third = 0, fourth = 0, products = 0, previous = 0;
  int beyond = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    first += x;
    second += x * x;
    third += x * x * x;
    fourth += x * x * x * x;
    products += x * previous;
    previous = x;
    if (std::abs(x) > 3) ++beyond;
  }
  const double root = std::sqrt(static_cast<double>(draws));
  EXPECT_NEAR(first / draws, 0, 5 / root);
  EXPECT_NEAR(second / draws, 1, 5 * std::sqrt(2.0) / root);
  EXPECT_NEAR(third / draws, 0, 5 * std::sqrt(15.0) / root);
  EXPECT_NEAR(fourth / draws, 3, 5 * std::sqrt(96.0) / root);
  EXPECT_NEAR(products / draws, 0, 5 / root);
  EXPECT_NEAR(beyond, 0.0026998 * draws, 5 * std::sqrt(0.0027 * draws));
}

TEST(RandomStream, DirectionIsUniformOnTheSphere) {
  RandomStream random(7);
  std::vector<int> heights(20, 0), sectors(20, 0);
  for (int draw = 0; draw < 40000; ++draw) {
    const Eigen::Vector3d direction = random.direction();
    ASSERT_NEAR(direction.norm(), 1, 1e-14);
    // Each coordinate of a uniform direction is uniform.
    ++heights[std::min<std::size_t>(19, static_cast<std::size_t>(10 * (direction.z() + 1)))];
    const double turn = (std::atan2(direction.y(), direction.x()) / std::acos(-1.0) + 1) / 2;
    ++sectors[std::min<std::size_t>(19, static_cast<std::size_t>(20 * turn))];
  }
  EXPECT_LT(chi_square(heights, 40000), chi_square_limit(20));
  EXPECT_LT(chi_square(sectors, 40000), chi_square_limit(20));
}

TEST(RandomStream, RotationIsUniform) {
  RandomStream random(8);
  const int draws = 40000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double squared_trace = 0;
  std::vector<int> heights(20, 0);
  for (int draw = 0; draw < draws; ++draw) {
    const Eigen::Matrix3d rotation = random.rotation();
    ASSERT_TRUE(is_rotation(rotation, 1e-13));
    sum += rotation;
    squared_trace += rotation.trace() * rotation.trace();
    ++heights[std::min<std::size_t>(19, static_cast<std::size_t>(10 * (rotation(0, 2) + 1)))];
  }
  // Entries have mean 0 and variance 1/3; the trace has mean 0, variance 1 and fourth moment 3.
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / draws, 5 * std::sqrt(1.0 / 3 / draws));
  EXPECT_NEAR(squared_trace / draws, 1, 5 * std::sqrt(2.0 / draws));
  EXPECT_LT(chi_square(heights, draws), chi_square_limit(20));
}

TEST(DeriveSeed, NameAndSeedBothMatter) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (const char* name : {"", "a", "b", "ab", "ba", "aa", "a ", "pair 1", "pair 2"})
      seeds.insert(derive_seed(seed, name));
  EXPECT_EQ(seeds.size(), 50u * 9u);
  EXPECT_EQ(derive_seed(7, "pair"), derive_seed(7, "pair"));
  EXPECT_NE(derive_seed(7, std::string("a\0b", 3)), derive_seed(7, std::string("a\0c", 3)));
}

TEST(DeriveSeed, IsFixed) {
  EXPECT_EQ(derive_seed(0, ""), 12035550249420947055u);
  EXPECT_EQ(derive_seed(0, "pair"), 5439652086168192382u);
  EXPECT_EQ(derive_seed(1, ""), 6791897765849424158u);
  EXPECT_EQ(derive_seed(1, "pair"), 9207157317873548008u);
}

}  // namespace
}  // namespace corral
