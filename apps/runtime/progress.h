// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace corral {

/// A progress bar with the time left, on stderr and only if that is a terminal. Gone when it is destroyed.
class Progress {
 public:
  explicit Progress(double total_steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says what begins now; everything announced before is done. `steps`: its share of the whole.
  void begin(const std::string& what, double steps = 1);

 private:
  bool shown_;
  double total_, done_ = 0, current_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace corral
