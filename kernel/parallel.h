// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace corral {

/// Calls body(0) .. body(count - 1), each once, in any order and on any threads, and returns when all are done. A caller
/// that has threads passes one; results never depend on it.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// One after the other, in the calling thread.
inline void one_by_one(int count, const std::function<void(int)>& body) {
  for (int i = 0; i < count; ++i) body(i);
}

}  // namespace corral
