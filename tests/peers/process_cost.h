// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

namespace corral::peers {

/// What this process has used so far.
struct ProcessCost {
  double cpu_s = 0;           ///< of all threads, user and system
  double peak_memory_mb = 0;  ///< largest resident set
};

inline ProcessCost process_cost() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024};
}

}  // namespace corral::peers
