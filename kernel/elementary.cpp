// SPDX-License-Identifier: MIT
#include "kernel/elementary.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace corral {

namespace {

constexpr int kExponentialTerms = 13, kArcSineTerms = 12;

/// 1/k! of the series of e^x, and of that of arc sin x = x (1 + 1/2 x^2/3 + 1/2 3/4 x^4/5 + ...) the factors of x^2k.
struct Series {
  double exponential[kExponentialTerms + 1] = {1}, arc_sine[kArcSineTerms + 1] = {1};
  constexpr Series() {
    double factorial = 1, product = 1;
    for (int k = 1; k <= kExponentialTerms; ++k) exponential[k] = 1 / (factorial *= k);
    for (int k = 1; k <= kArcSineTerms; ++k) arc_sine[k] = (product *= (2.0 * k - 1) / (2 * k)) / (2 * k + 1);
  }
};
constexpr Series kSeries;

/// 2^n, of a normal number.
double power_of_two(int n) {
  const std::uint64_t bits = static_cast<std::uint64_t>(n + 1023) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

}  // namespace

/// e^x = 2^n e^r with |r| <= ln 2 / 2.
double exponential(double x) {
  constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;  // n times the first is exact
  if (!(x >= -700)) return 0;
  const double n = std::floor(x * 1.4426950408889634 + 0.5), r = (x - n * kLn2High) - n * kLn2Low;
  double sum = 0;
  for (int k = kExponentialTerms; k >= 0; --k) sum = kSeries.exponential[k] + sum * r;
  return sum * power_of_two(static_cast<int>(n));
}

/// Newton's iteration from above, until it rests.
double logarithm(double x) {
  double y = x - 1;
  for (int round = 0; round < 1000; ++round) {
    const double next = y + (x / exponential(y) - 1);
    if (!(next < y)) break;
    y = next;
  }
  return y;
}

/// Halley's iteration on a number between 1/2 and 4.
double cube_root(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  double number = std::frexp(x, &exponent);
  const int rest = ((exponent % 3) + 3) % 3;
  number *= power_of_two(rest);
  double root = 0.65 + 0.25 * number;
  for (int round = 0; round < 4; ++round) {
    const double cube = root * root * root;
    root = root * ((cube + 2 * number) / (2 * cube + number));
  }
  return root * power_of_two((exponent - rest) / 3);
}

/// Half the angle three times, sin(a/2) = sin a / sqrt(2 (1 + cos a)); then the series.
double arc_sine(double x) {
  for (int halving = 0; halving < 3; ++halving) x = x / std::sqrt(2 * (1 + std::sqrt((1 - x) * (1 + x))));
  const double square = x * x;
  double sum = 0;
  for (int k = kArcSineTerms; k >= 0; --k) sum = kSeries.arc_sine[k] + sum * square;
  return 8 * x * sum;
}

}  // namespace corral
