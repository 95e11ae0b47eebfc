// SPDX-License-Identifier: MIT
#include "kernel/vectorized.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "kernel/random.h"
#include "tests/support/execution.h"

namespace corral {
namespace {

using testing::available_levels;
using testing::ForcedLevel;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Eight numbers; compared by their bits, so that signs of zero and NaN count.
struct Eight {
  double values[kLanes];
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// What lanes make of two registers at every level, against one number after the other.
template <class OnLanes, class OnNumbers>
void expect_same(const Eight& a, const Eight& b, const OnLanes& on_lanes, const OnNumbers& on_numbers) {
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    Eight found{};
    vectorized([&](auto kind) {
      using Lanes = typename decltype(kind)::Lanes;
      on_lanes(Lanes::load(a.values), Lanes::load(b.values)).store(found.values);
    });
    for (int i = 0; i < kLanes; ++i) {
      const double expected = on_numbers(a.values[i], b.values[i]);
      EXPECT_TRUE(same_bits(found.values[i], expected) || (std::isnan(found.values[i]) && std::isnan(expected)))
          << "level " << static_cast<int>(level) << ", lane " << i << ": " << found.values[i] << " for " << expected;
    }
  }
}

const Eight kA{{0.1, -2.5, 1e300, 3e-310, -0.0, 7, -1e-17, 1.0 / 3}};
const Eight kB{{0.3, -2.5, 1e300, -5e-324, 0.0, -11, 1, 3.0}};
const Eight kOdd{{kInfinity, -kInfinity, std::nan(""), 0.0, -0.0, 1, std::nan(""), 5}};
const Eight kOther{{1, -kInfinity, 2, -0.0, 0.0, std::nan(""), std::nan(""), kInfinity}};

template <class OnLanes, class OnNumbers>
void expect_same_for_all(const OnLanes& on_lanes, const OnNumbers& on_numbers) {
  for (const auto& [a, b] : {std::pair(kA, kB), std::pair(kB, kA), std::pair(kOdd, kOther), std::pair(kA, kOdd)})
    expect_same(a, b, on_lanes, on_numbers);
}

TEST(Lanes, ArithmeticIsThatOfSingleNumbers) {
  expect_same_for_all([](auto a, auto b) { return a + b; }, [](double a, double b) { return a + b; });
  expect_same_for_all([](auto a, auto b) { return a - b; }, [](double a, double b) { return a - b; });
  expect_same_for_all([](auto a, auto b) { return a * b; }, [](double a, double b) { return a * b; });
  expect_same_for_all([](auto a, auto b) { return a / b; }, [](double a, double b) { return a / b; });
  expect_same_for_all([](auto a, auto) { return square_root(a); }, [](double a, double) { return std::sqrt(a); });
}

TEST(Lanes, NothingIsContracted) {
  // Fused, these would keep digits that the product alone has not.
  const Eight a{{0.1, 1 + 0x1p-30, 1.0 / 3, 1e8 + 0.1, -0.7, 3.3, 1e-9, 17.17}}, b = a;
  expect_same(
      a, b, [](auto x, auto y) { return x * y - y * x + x * x - y; },
      [](double x, double y) {
        volatile double xy = x * y, yx = y * x, xx = x * x;
        return xy - yx + xx - y;
      });
}

TEST(Lanes, ComparisonsChoose) {
  expect_same_for_all([](auto a, auto b) { return select(a < b, a, b + b); },
                      [](double a, double b) { return a < b ? a : b + b; });
  expect_same_for_all([](auto a, auto b) { return select(a <= b, a, b + b); },
                      [](double a, double b) { return a <= b ? a : b + b; });
  expect_same_for_all([](auto a, auto b) { return select(a == b, a, b + b); },
                      [](double a, double b) { return a == b ? a : b + b; });
  expect_same_for_all([](auto a, auto b) { return smaller(a, b); }, [](double a, double b) { return a < b ? a : b; });
}

TEST(Lanes, MagnitudeHasNoSign) {
  expect_same_for_all([](auto a, auto) { return magnitude(a) + decltype(a)::fill(0); },
                      [](double a, double) { return std::abs(a) + 0; });
}

TEST(Lanes, FillIsTheSameEverywhere) {
  for (const double number : {0.1, -7.0, kInfinity, 5e-324})
    expect_same_for_all([&](auto a, auto) { return decltype(a)::fill(number); },
                        [&](double, double) { return number; });
}

TEST(Lanes, WholeNumbersAreStoredAsSuch) {
  const Eight numbers{{0, -1, 2147483647, -2147483648.0, 352, 7, -0.0, 99}};
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    std::int32_t found[kLanes] = {};
    vectorized([&](auto kind) { decltype(kind)::Lanes::load(numbers.values).store(found); });
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(found[i], static_cast<std::int32_t>(numbers.values[i]));
  }
}

TEST(Lanes, SumHasOneOrder) {
  RandomStream random(1);
  for (int trial = 0; trial < 100; ++trial) {  // any other order would lose other digits, sooner or later
    double v[kLanes];
    for (double& value : v) value = random.uniform(-1, 1) * std::pow(10, random.uniform(-3, 3));
    const double expected = ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
    for (const VectorLevel level : available_levels()) {
      const ForcedLevel forced(level);
      double found = 0;
      vectorized([&](auto kind) { found = sum(decltype(kind)::Lanes::load(v)); });
      EXPECT_TRUE(same_bits(found, expected)) << found;
    }
  }
}

TEST(Lanes, SmallestIsFoundInEveryLane) {
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    for (int at = 0; at < kLanes; ++at) {
      Eight numbers{{5, 4, 6, kInfinity, 3, 9, 8, 7}};
      numbers.values[at] = -1;
      double least = 0;
      vectorized([&](auto kind) { least = smallest(decltype(kind)::Lanes::load(numbers.values)); });
      EXPECT_EQ(least, -1) << at;
    }
  }
}

TEST(VectorLevel, IsNeverBeyondTheMachine) {
  const VectorLevel best = vector_level();
  for (const VectorLevel level : {VectorLevel::Avx512, VectorLevel::Avx2, VectorLevel::Baseline}) {
    const ForcedLevel forced(level);
    EXPECT_EQ(vector_level(), std::min(level, best));
  }
  EXPECT_EQ(vector_level(), best) << "restored";
}

TEST(Vectorized, RunsOnceInTheLanesOfTheLevel) {
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    int calls = 0;
    vectorized([&](auto kind) {
      using Lanes = typename decltype(kind)::Lanes;
      static_assert(Lanes::kCount == kLanes);
      ++calls;
      EXPECT_EQ((std::is_same_v<Lanes, lanes::Lanes8>), level == VectorLevel::Avx512);
      EXPECT_EQ((std::is_same_v<Lanes, lanes::Lanes4x2>), level == VectorLevel::Avx2);
      EXPECT_EQ((std::is_same_v<Lanes, lanes::Lanes2x4>), level == VectorLevel::Baseline);
    });
    EXPECT_EQ(calls, 1);
  }
}

TEST(Padded, IsTheNextMultipleOfTheLanes) {
  for (int count = 0; count < 40; ++count) {
    EXPECT_EQ(padded(count) % kLanes, 0);
    EXPECT_GE(padded(count), count);
    EXPECT_LT(padded(count), count + kLanes);
  }
}

TEST(AlignedColumn, StartsAtACacheLine) {
  for (std::size_t size = 1; size < 200; size += 13) {
    const AlignedColumn column(size, 1.0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % 64, 0u);
    EXPECT_EQ(column, AlignedColumn(column));
  }
}

TEST(Lanes, BitsSayWhereAComparisonIsTrue) {
  const float nan = std::nanf("");
  const float a[kFloatLanes] = {1, 2, 3, 4, -1, -0.0F, nan, 7, 8, nan, 0, 1, 2, 3, 4, 5},
              b[kFloatLanes] = {1, 3, 2, 4, -2, 0.0F, 1, nan, 9, nan, 1, 0, 2, 4, 3, 5};
  unsigned less = 0, less_equal = 0, equal = 0, lanes_less = 0;
  for (unsigned i = 0; i < kFloatLanes; ++i)
    less |= unsigned{a[i] < b[i]} << i, less_equal |= unsigned{a[i] <= b[i]} << i, equal |= unsigned{a[i] == b[i]} << i;
  for (unsigned i = 0; i < kLanes; ++i) lanes_less |= unsigned{kOdd.values[i] < kOther.values[i]} << i;
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    vectorized([&](auto kind) {
      using Floats = typename decltype(kind)::Floats;
      using Lanes = typename decltype(kind)::Lanes;
      const Floats x = Floats::load(a), y = Floats::load(b);
      EXPECT_EQ(bits(x < y), less);
      EXPECT_EQ(bits(x <= y), less_equal);
      EXPECT_EQ(bits(x == y), equal);
      EXPECT_EQ(bits(Lanes::load(kOdd.values) < Lanes::load(kOther.values)), lanes_less);
      EXPECT_EQ(bits(Lanes::load(kA.values) <= Lanes::load(kA.values)), 0xffU);
    });
  }
}

TEST(Lanes, PackedNumbersFollowEachOther) {
  float numbers[kFloatLanes];
  for (int i = 0; i < kFloatLanes; ++i) numbers[i] = static_cast<float>(i) - 3.5F;
  for (const VectorLevel level : available_levels()) {
    const ForcedLevel forced(level);
    for (const unsigned which : {0U, 1U, 0x8000U, 0xffffU, 0x00ffU, 0xff00U, 0x1248U, 0xa5a5U}) {
      float packed[kFloatLanes + 1] = {};
      packed[kFloatLanes] = 77;
      vectorized([&](auto kind) {
        using Floats = typename decltype(kind)::Floats;
        Floats::load(numbers).pack(which, packed);
      });
      int next = 0;
      for (unsigned i = 0; i < kFloatLanes; ++i)
        if ((which >> i & 1) != 0) {
          EXPECT_EQ(packed[next++], numbers[i]) << which;
        }
      EXPECT_EQ(packed[kFloatLanes], 77);
    }
  }
}

}  // namespace
}  // namespace corral
