// SPDX-License-Identifier: MIT
#include "apps/runtime/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace corral {

Progress::Progress(double total_steps) : shown_(::isatty(STDERR_FILENO) == 1), total_(total_steps) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::begin(const std::string& what, double steps) {
  done_ += current_;
  current_ = steps;
  if (!shown_) return;
  const double share = std::min(done_ / total_, 1.0);
  constexpr int kWidth = 24;
  const int full = static_cast<int>(share * kWidth);
  std::string left;
  if (share > 0.05) {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    left = ", about " + std::to_string(static_cast<int>(std::ceil(elapsed * (1 - share) / share))) + " s left";
  }
  std::fprintf(stderr, "\r\033[K[%s%s] %3.0f %%  %s%s", std::string(static_cast<std::size_t>(full), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - full), '.').c_str(), 100 * share, what.c_str(),
               left.c_str());
  std::fflush(stderr);
}

}  // namespace corral
