// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

namespace corral {

/// The most memory that this process has held so far, in MB (10^6 bytes).
inline double peak_memory_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1.024e-3;
}

}  // namespace corral
