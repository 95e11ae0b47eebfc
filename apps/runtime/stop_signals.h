// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace corral {

/// While it lives, SIGINT and SIGTERM end the program in order: `on_stop` is called in a thread of its own, then the program
/// ends at once with 128 + the number of the signal (130, 143). To be made before the threads that it should hold for.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> on_stop);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  std::function<void()> on_stop_;
  sigset_t before_{};
  std::atomic<bool> is_over_{false};
  std::thread waiting_;
};

}  // namespace corral
