// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace corral {

/// The local reference frames that matches carry: those of SHOT, whatever describes the keypoints, or none.
enum class LocalFrames { Shot, None };
constexpr std::array<const char*, 2> choice_names(LocalFrames) { return {"shot", "none"}; }

}  // namespace corral
