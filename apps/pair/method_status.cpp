// SPDX-License-Identifier: MIT
#include "apps/pair/method_status.h"

namespace corral {
namespace {

/// In the order of MethodState; those that end in a colon have a cause.
const char* const kWords[] = {"refined", "too few rows", "degenerate geometry", "diverged", "not converged", "timed",
                              "",        "too large: ",  "not applicable: ",    "failed: "};

bool has_cause(MethodState state) { return state >= MethodState::TooLarge; }

}  // namespace

MethodStatus status_of(const RefinedPose& pose) {
  if (pose.status == RefineStatus::Refined && !pose.converged) return {MethodState::NotConverged};
  return {static_cast<MethodState>(pose.status)};
}

std::string to_text(const MethodStatus& status) { return kWords[static_cast<int>(status.state)] + status.cause; }

std::optional<MethodStatus> parse_status(const std::string& text) {
  for (int place = 0; place <= static_cast<int>(MethodState::Failed); ++place) {
    const auto state = static_cast<MethodState>(place);
    const std::string word = kWords[place];
    if (has_cause(state) && text.rfind(word, 0) == 0) return MethodStatus{state, text.substr(word.size())};
    if (!has_cause(state) && text == word) return MethodStatus{state};
  }
  return std::nullopt;
}

}  // namespace corral
