// SPDX-License-Identifier: MIT
#include "apps/workers.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>

namespace corral {

ParallelFor workers(int threads) {
  if (threads == 1) return one_by_one;
  const auto arena =
      std::make_shared<oneapi::tbb::task_arena>(threads == 0 ? +oneapi::tbb::task_arena::automatic : threads);
  return [arena](int count, const std::function<void(int)>& body) {
    arena->execute([&] { oneapi::tbb::parallel_for(0, count, body); });
  };
}

}  // namespace corral
