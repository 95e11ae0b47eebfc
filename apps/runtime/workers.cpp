// SPDX-License-Identifier: MIT
#include "apps/runtime/workers.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>

namespace corral {

ParallelFor workers(int threads) {
  if (threads == 1) return one_by_one;
  using oneapi::tbb::global_control;
  // More threads than processors are allowed, without a warning of the library.
  const auto limit = threads == 0 ? nullptr
                                  : std::make_shared<global_control>(global_control::max_allowed_parallelism,
                                                                     static_cast<std::size_t>(threads));
  const auto arena =
      std::make_shared<oneapi::tbb::task_arena>(threads == 0 ? +oneapi::tbb::task_arena::automatic : threads);
  return [limit, arena](int count, const std::function<void(int)>& body) {
    arena->execute([&] { oneapi::tbb::parallel_for(0, count, body); });
  };
}

}  // namespace corral
