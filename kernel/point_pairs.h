// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/columns.h"
#include "kernel/types.h"

namespace corral {

/// Points and the nearest ones of a target, in columns of whole registers; what is past the last point has no partner.
struct PointPairs {
  AlignedColumn source[3];  ///< the points
  AlignedColumn target[3];  ///< their partners; anything where there is none
  Indices target_rows;      ///< of the partners; -1: no target point is near enough
};

}  // namespace corral
