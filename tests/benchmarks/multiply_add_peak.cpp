// SPDX-License-Identifier: MIT
#include "tests/benchmarks/multiply_add_peak.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/multiply_add_peak.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr int kRounds = 1 << 19;

/// How many chains of sixteen floats: enough to hide the latency, as few as the registers hold beside the two factors.
constexpr int kChains = HWY_LANES(float) >= 16 ? 12 : HWY_LANES(float) == 8 || HWY_TARGET == HWY_NEON ? 6 : 3;

/// x -> factor * x + term, kRounds times, in every lane of every chain; no two start alike, or they would be computed once.
/// Returns how many operations that are.
HWY_FLATTEN double run_chains(const float* starts, float factor, float term, float* result) {
  const Floats a = Floats::fill(factor), b = Floats::fill(term);
  Floats chains[kChains];
  HWY_UNROLL(16)
  for (int i = 0; i < kChains; ++i) chains[i] = Floats::load(starts + 16 * i);
  for (int round = 0; round < kRounds; ++round) {
    HWY_UNROLL(16)
    for (int i = 0; i < kChains; ++i) chains[i] = chains[i] * a + b;
  }
  HWY_UNROLL(16)
  for (int i = 1; i < kChains; ++i) chains[0] = chains[0] + chains[i];
  *result = sum(chains[0]);
  return 2.0 * kFloatLanes * kChains * kRounds;
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(run_chains);

double benchmarks::multiply_add_peak() {
  using Clock = std::chrono::steady_clock;
  constexpr int kRuns = 25;
  volatile float factor = 0.5F, term = 1;  // nothing is computed beforehand
  std::vector<float> starts(16 * kFloatLanes);
  std::iota(starts.begin(), starts.end(), 0.0F);
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    float result = 0;
    const auto start = Clock::now();
    const double operations = HWY_DYNAMIC_DISPATCH(run_chains)(starts.data(), factor, term, &result);
    best = std::max(best, operations / std::chrono::duration<double>(Clock::now() - start).count());
    factor = result > 0 ? 0.5F : 0.25F;  // nothing is computed for nobody
  }
  return best / 1e9;
}

}  // namespace corral
#endif
