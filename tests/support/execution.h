// SPDX-License-Identifier: MIT
#pragma once

// The ways in which a machine may run the loops: no result may tell them apart.

#include <atomic>
#include <thread>
#include <vector>

#include "kernel/parallel.h"
#include "kernel/vectorized.h"

namespace corral::testing {

/// Forces a vector level as long as it lives.
class ForcedLevel {
 public:
  explicit ForcedLevel(VectorLevel level) : before_(vector_level()) { force_vector_level(level); }
  ~ForcedLevel() { force_vector_level(before_); }
  ForcedLevel(const ForcedLevel&) = delete;
  ForcedLevel& operator=(const ForcedLevel&) = delete;

 private:
  VectorLevel before_;
};

/// Those that this machine has, the lowest first.
inline std::vector<VectorLevel> available_levels() {
  std::vector<VectorLevel> levels;
  for (const VectorLevel level : {VectorLevel::Baseline, VectorLevel::Avx2, VectorLevel::Avx512})
    if (level <= vector_level()) levels.push_back(level);
  return levels;
}

inline void last_first(int count, const std::function<void(int)>& body) {
  for (int i = count - 1; i >= 0; --i) body(i);
}

/// Whoever is free takes the next one; the bodies must not throw.
inline void on_three_threads(int count, const std::function<void(int)>& body) {
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread)
    threads.emplace_back([&] {
      for (int i = next++; i < count; i = next++) body(i);
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace corral::testing
