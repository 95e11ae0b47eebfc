// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/columns.h"
#include "kernel/random.h"
#include "tests/support/execution.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/kernel/lanes_test.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

static_assert(Lanes::kCount == kLanes && Floats::kCount == kFloatLanes);

std::int64_t target() { return HWY_TARGET; }

/// What lanes make of two times eight numbers, one behind the other.
void compute(const double* x, const double* y, double* results) {
  const Lanes a = Lanes::load(x), b = Lanes::load(y),
              all[] = {a + b,
                       a - b,
                       a * b,
                       a / b,
                       square_root(a),
                       magnitude(a) + Lanes::fill(0),
                       select(a < b, a, b + b),
                       select(a <= b, a, b + b),
                       select(a == b, a, b + b),
                       smaller(a, b),
                       larger(a, b),
                       a * b - b * a + a * a - b,
                       Lanes::fill(y[3])};
  for (const Lanes& each : all) each.store(results), results += kLanes;
}

void reduce(const double* numbers, double* results) {
  const Lanes lanes = Lanes::load(numbers);
  results[0] = sum(lanes), results[1] = smallest(lanes), results[2] = largest(lanes);
}

void compare(const float* x, const float* y, unsigned* results) {
  const Floats a = Floats::load(x), b = Floats::load(y);
  results[0] = bits(a < b), results[1] = bits(a <= b), results[2] = bits(a == b);
}

unsigned compare_doubles(const double* x, const double* y) { return bits(Lanes::load(x) < Lanes::load(y)); }

void pack(const float* numbers, unsigned which, float* to) { Floats::load(numbers).pack(which, to); }
void pack_doubles(const double* numbers, unsigned which, double* to) { Lanes::load(numbers).pack(which, to); }

void convert(const double* numbers, float* floats, std::int32_t* integers, std::uint8_t* bytes) {
  const Lanes lanes = Lanes::load(numbers);
  lanes.store(floats), lanes.store(integers), magnitude(lanes).store(bytes);
}
void convert_floats(const float* numbers, std::int32_t* integers, std::uint8_t* bytes) {
  const Floats floats = Floats::load(numbers);
  floats.store(integers), magnitude(floats).store(bytes);
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {
namespace {

HWY_EXPORT(target);
HWY_EXPORT(compute);
HWY_EXPORT(reduce);
HWY_EXPORT(compare);
HWY_EXPORT(compare_doubles);
HWY_EXPORT(pack);
HWY_EXPORT(pack_doubles);
HWY_EXPORT(convert);
HWY_EXPORT(convert_floats);

using testing::available_targets;
using testing::ForcedTarget;
using testing::target_name;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// What compute() should make of two numbers. Volatile: nothing is contracted.
std::vector<double> expected(double a, double b, double filled) {
  volatile double ab = a * b, ba = b * a, aa = a * a;
  return {a + b,
          a - b,
          a * b,
          a / b,
          std::sqrt(a),
          std::abs(a) + 0,
          a < b ? a : b + b,
          a <= b ? a : b + b,
          a == b ? a : b + b,
          a < b ? a : b,
          a < b ? b : a,
          ab - ba + aa - b,
          filled};
}

using Eight = double[kLanes];
const Eight kA{0.1, -2.5, 1e300, 3e-310, -0.0, 7, -1e-17, 1.0 / 3};
const Eight kB{0.3, -2.5, 1e300, -5e-324, 0.0, -11, 1, 3.0};
const Eight kOdd{kInfinity, -kInfinity, std::nan(""), 0.0, -0.0, 1, std::nan(""), 5};
const Eight kOther{1, -kInfinity, 2, -0.0, 0.0, std::nan(""), std::nan(""), kInfinity};
const Eight kDigits{0.1,  1 + 0x1p-30, 1.0 / 3, 1e8 + 0.1,
                    -0.7, 3.3,         1e-9,    17.17};  // of products that a fused one keeps

TEST(Lanes, EveryTargetRunsItsOwnCode) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    EXPECT_EQ(HWY_DYNAMIC_DISPATCH(target)(), each) << target_name(each);
  }
  EXPECT_EQ(HWY_DYNAMIC_DISPATCH(target)(), available_targets().front()) << "restored";
}

/// Bit by bit, so that signs of zero count.
TEST(Lanes, EachIsComputedAsASingleNumber) {
  const Eight* const pairs[][2] = {{&kA, &kB}, {&kB, &kA}, {&kOdd, &kOther}, {&kA, &kOdd}, {&kDigits, &kDigits}};
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    for (const auto& [a, b] : pairs) {
      double found[13 * kLanes];
      HWY_DYNAMIC_DISPATCH(compute)(*a, *b, found);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto numbers = expected((*a)[lane], (*b)[lane], (*b)[3]);
        for (std::size_t i = 0; i < numbers.size(); ++i)
          EXPECT_TRUE(same_bits(found[i * kLanes + lane], numbers[i]) ||
                      (std::isnan(found[i * kLanes + lane]) && std::isnan(numbers[i])))
              << target_name(each) << ", operation " << i << ", lane " << lane << ": " << found[i * kLanes + lane]
              << " for " << numbers[i];
      }
    }
  }
}

TEST(Lanes, SumHasOneOrder) {
  RandomStream random(1);
  for (int trial = 0; trial < 100; ++trial) {  // any other order would lose other digits, sooner or later
    Eight v;
    for (double& value : v) value = random.uniform(-1, 1) * std::pow(10, random.uniform(-3, 3));
    const double sum = ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
    for (const std::int64_t each : available_targets()) {
      const ForcedTarget forced(each);
      double found[3];
      HWY_DYNAMIC_DISPATCH(reduce)(v, found);
      EXPECT_TRUE(same_bits(found[0], sum)) << target_name(each);
    }
  }
}

TEST(Lanes, ExtremesAreFoundInEveryLane) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    for (std::size_t at = 0; at < kLanes; ++at) {
      Eight numbers{5, 4, 6, kInfinity, 3, 9, 8, 7};
      double found[3];
      numbers[at] = -1;
      HWY_DYNAMIC_DISPATCH(reduce)(numbers, found);
      EXPECT_EQ(found[1], -1) << at;
      numbers[3] = 0, numbers[at] = 77;
      HWY_DYNAMIC_DISPATCH(reduce)(numbers, found);
      EXPECT_EQ(found[2], 77) << at;
    }
  }
}

TEST(Lanes, BitsSayWhereAComparisonIsTrue) {
  const float nan = std::nanf("");
  const float a[kFloatLanes] = {1, 2, 3, 4, -1, -0.0F, nan, 7, 8, nan, 0, 1, 2, 3, 4, 5},
              b[kFloatLanes] = {1, 3, 2, 4, -2, 0.0F, 1, nan, 9, nan, 1, 0, 2, 4, 3, 5};
  unsigned less = 0, less_equal = 0, equal = 0, lanes_less = 0;
  for (unsigned i = 0; i < kFloatLanes; ++i)
    less |= unsigned{a[i] < b[i]} << i, less_equal |= unsigned{a[i] <= b[i]} << i, equal |= unsigned{a[i] == b[i]} << i;
  for (unsigned i = 0; i < kLanes; ++i) lanes_less |= unsigned{kOdd[i] < kOther[i]} << i;
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    unsigned found[3];
    HWY_DYNAMIC_DISPATCH(compare)(a, b, found);
    EXPECT_EQ(found[0], less) << target_name(each);
    EXPECT_EQ(found[1], less_equal) << target_name(each);
    EXPECT_EQ(found[2], equal) << target_name(each);
    EXPECT_EQ(HWY_DYNAMIC_DISPATCH(compare_doubles)(kOdd, kOther), lanes_less) << target_name(each);
  }
}

template <class Number, std::size_t kCount, class Pack>
void expect_packed(const Pack& pack, unsigned which) {
  Number numbers[kCount], packed[kCount + 1] = {};
  for (std::size_t i = 0; i < kCount; ++i) numbers[i] = static_cast<Number>(i) - Number{3.5};
  packed[kCount] = 77;
  pack(numbers, which, packed);
  int next = 0;
  for (unsigned i = 0; i < kCount; ++i)
    if ((which >> i & 1) != 0) {
      EXPECT_EQ(packed[next++], numbers[i]) << which;
    }
  EXPECT_EQ(packed[kCount], 77);
}

TEST(Lanes, PackedNumbersFollowEachOther) {
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    for (const unsigned which : {0U, 1U, 0x8000U, 0xffffU, 0x00ffU, 0xff00U, 0x1248U, 0xa5a5U})
      expect_packed<float, kFloatLanes>(HWY_DYNAMIC_DISPATCH(pack), which);
    for (unsigned which = 0; which < 256; ++which)
      expect_packed<double, kLanes>(HWY_DYNAMIC_DISPATCH(pack_doubles), which);
  }
}

TEST(Lanes, NumbersAreStoredInOtherTypes) {
  const Eight whole{0, -1, 2147483647, -2147483648.0, 352, 7, -0.0, 99}, small{0, 255, 1, -128, 3, 7, -0.0, 99};
  float sixteen[kFloatLanes];
  for (int i = 0; i < kFloatLanes; ++i) sixteen[i] = static_cast<float>(17 * i * (i % 2 == 0 ? 1 : -1));
  for (const std::int64_t each : available_targets()) {
    const ForcedTarget forced(each);
    float floats[kLanes];
    std::int32_t integers[kFloatLanes];
    std::uint8_t bytes[kFloatLanes];
    HWY_DYNAMIC_DISPATCH(convert)(whole, floats, integers, bytes);
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(integers[i], static_cast<std::int32_t>(whole[i])) << target_name(each);
    HWY_DYNAMIC_DISPATCH(convert)(small, floats, integers, bytes);
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(bytes[i], std::abs(small[i])) << target_name(each);
    HWY_DYNAMIC_DISPATCH(convert)(kDigits, floats, integers, bytes);
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(floats[i], static_cast<float>(kDigits[i])) << target_name(each);
    HWY_DYNAMIC_DISPATCH(convert_floats)(sixteen, integers, bytes);
    for (int i = 0; i < kFloatLanes; ++i) {
      EXPECT_EQ(integers[i], static_cast<std::int32_t>(sixteen[i])) << target_name(each);
      EXPECT_EQ(bytes[i], std::abs(sixteen[i])) << target_name(each);
    }
  }
}

}  // namespace
}  // namespace corral
#endif
