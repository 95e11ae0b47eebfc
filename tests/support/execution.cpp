// SPDX-License-Identifier: MIT
#include "tests/support/execution.h"

#include <hwy/highway.h>

namespace corral::testing {

std::vector<std::int64_t> available_targets() {
  static const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();  // before one is forced
  return targets;
}

std::string target_name(std::int64_t target) { return hwy::TargetName(target); }

ForcedTarget::ForcedTarget(std::int64_t target) : before_(hwy::SupportedTargets()) {
  available_targets();
  hwy::SetSupportedTargetsForTest(target);
}

ForcedTarget::~ForcedTarget() { hwy::SetSupportedTargetsForTest(before_); }

}  // namespace corral::testing
