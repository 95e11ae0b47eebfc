// SPDX-License-Identifier: MIT
#include "kernel/vectorized.h"

#include <algorithm>
#include <atomic>

namespace corral {
namespace {

VectorLevel best_level() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return VectorLevel::Avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return VectorLevel::Avx2;
  return VectorLevel::Baseline;
}

std::atomic<VectorLevel>& current_level() {
  static std::atomic<VectorLevel> level{best_level()};
  return level;
}

}  // namespace

VectorLevel vector_level() { return current_level().load(std::memory_order_relaxed); }

void force_vector_level(VectorLevel level) { current_level() = std::min(level, best_level()); }

}  // namespace corral
