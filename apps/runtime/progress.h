// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace corral {

/// A progress bar with the remaining time, on stderr if that is a terminal. It is erased on destruction.
class Progress {
 public:
  explicit Progress(double total_steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Announces the next step; all earlier ones are done. `steps`: its share of the work.
  void begin(const std::string& what, double steps = 1);

 private:
  bool shown_;
  double total_, done_ = 0, current_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace corral
