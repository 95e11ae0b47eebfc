// SPDX-License-Identifier: MIT
#include "tests/benchmarks/multiply_add_peak.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

#include "kernel/vectorized.h"

namespace corral::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRounds = 1 << 19;
constexpr int kRuns = 25;

/// How many chains of sixteen floats: enough to hide the latency, as few as the registers hold beside the two factors.
template <class Floats>
constexpr int kChains = 3;
template <>
constexpr int kChains<lanes::Floats8x2> = 6;
template <>
constexpr int kChains<lanes::Floats16> = 12;

/// x -> factor * x + term, kRounds times, in every lane of every chain; no two start alike, or they would be computed once.
template <class Floats>
CORRAL_INLINE float run_chains(const float* starts, float factor, float term) {
  constexpr int kCount = kChains<Floats>;
  const Floats a = Floats::fill(factor), b = Floats::fill(term);
  Floats chains[kCount];
#pragma GCC unroll 16
  for (int i = 0; i < kCount; ++i) chains[i] = Floats::load(starts + 16 * i);
  for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 16
    for (int i = 0; i < kCount; ++i) chains[i] = chains[i] * a + b;
  }
#pragma GCC unroll 16
  for (int i = 1; i < kCount; ++i) chains[0] = chains[0] + chains[i];
  float values[16];
  chains[0].store(values);
  return std::accumulate(values, values + 16, 0.0F);
}

}  // namespace

double multiply_add_peak() {
  volatile float factor = 0.5F, term = 1,
                 result = 0;  // volatile: nothing is precomputed or optimised away
  std::vector<float> starts(16 * 16);
  std::iota(starts.begin(), starts.end(), 0.0F);
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    double operations = 0;
    const auto start = Clock::now();
    vectorized([&](auto kind) {
      using Floats = typename decltype(kind)::Floats;
      operations = 2.0 * 16 * kChains<Floats> * kRounds;
      result = run_chains<Floats>(starts.data(), factor, term);
    });
    best = std::max(best, operations / std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best / 1e9;
}

}  // namespace corral::benchmarks
