// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/types.h"

namespace corral {

/// Where a surface is described.
struct Keypoints {
  Indices vertices;    ///< ascending
  int candidates = 0;  ///< local maxima that they were selected from
};

}  // namespace corral
