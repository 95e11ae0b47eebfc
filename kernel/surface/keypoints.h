// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/types.h"

namespace corral {

/// The vertices at which a surface is described.
struct Keypoints {
  Indices vertices;    ///< ascending
  int candidates = 0;  ///< local maxima from which they were selected
};

}  // namespace corral
