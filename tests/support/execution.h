// SPDX-License-Identifier: MIT
#pragma once

// The ways in which a machine may run the loops: no result may tell them apart.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "kernel/parallel.h"

namespace corral::testing {

/// The targets of Highway that are compiled and that this machine has, the best first.
std::vector<std::int64_t> available_targets();

std::string target_name(std::int64_t target);

/// Has the loops run on one of them, in all threads, as long as it lives.
class ForcedTarget {
 public:
  explicit ForcedTarget(std::int64_t target);
  ~ForcedTarget();
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;

 private:
  std::int64_t before_;
};

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
