// SPDX-License-Identifier: MIT
#include "kernel/elementary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/random.h"

namespace corral {
namespace {

void expect_close(double found, double expected) {
  EXPECT_LE(std::abs(found - expected), 16 * 0x1p-53 * std::abs(expected)) << found << " " << expected;
}

TEST(Elementary, IsThatOfTheLibraryToAFewDigits) {
  RandomStream random(1);
  for (int draw = 0; draw < 20000; ++draw) {
    const double share = random.uniform();
    for (const double x : {-share, -share / 1024, -700 * share}) expect_close(exponential(x), std::exp(x));
    for (const double x : {share, share / 1024, share * 1e6, share * 1e-200}) expect_close(cube_root(x), std::cbrt(x));
    for (const double x : {share, share / 1024, 1 - share / 1024}) expect_close(arc_sine(x), std::asin(x));
    if (draw % 100 != 0 || share == 0) continue;
    for (const double x : {share, 1 - share / 1024}) EXPECT_NEAR(logarithm(x), std::log(x), 4e-16 * (1 - std::log(x)));
  }
}

TEST(Elementary, Ends) {
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-701), 0);
  EXPECT_EQ(exponential(-HUGE_VAL), 0);
  EXPECT_EQ(exponential(std::nan("")), 0);
  EXPECT_EQ(logarithm(1), 0);
  EXPECT_EQ(cube_root(0), 0);
  EXPECT_EQ(cube_root(8), 2);
  EXPECT_EQ(arc_sine(0), 0);
  expect_close(arc_sine(1), std::acos(-1.0) / 2);
  expect_close(cube_root(5e-324), std::cbrt(5e-324));
}

/// The bits that every machine must give.
TEST(Elementary, BitsAreFixed) {
  EXPECT_EQ(exponential(-0.01), 0x1.fae7cfd2b9cfep-1);
  EXPECT_EQ(exponential(-12.3), 0x1.31765fdaf4f37p-18);
  EXPECT_EQ(logarithm(0.99), -0x1.495453e6fd4cp-7);
  EXPECT_EQ(cube_root(0.7), 0x1.c69b5a72f1a9ap-1);
  EXPECT_EQ(arc_sine(0.3), 0x1.380159e14f7p-2);
}

}  // namespace
}  // namespace corral
