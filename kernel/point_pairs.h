// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/columns.h"
#include "kernel/types.h"

namespace corral {

/// Points and their nearest points of a target, in columns padded to whole vector registers; padding has no partner.
struct PointPairs {
  AlignedColumn source[3];  ///< the points
  AlignedColumn target[3];  ///< their partners; unspecified where there is none
  Indices target_rows;      ///< rows of the partners; -1 where no target point is near enough
};

}  // namespace corral
