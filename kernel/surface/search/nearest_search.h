// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "kernel/surface/search/nearest_points.h"

namespace corral {

// What NearestTracker searches. Only sources include this.

/// The queries, and what was found for each where it was searched last; `target` is infinite where nothing was near enough.
struct FollowedPoints : PointPairs {
  AlignedColumn was[3];     // where the query was searched
  AlignedColumn row;        // of the nearest point
  AlignedColumn second;     // distance of the next nearest that was met; infinite if none was near enough
  AlignedColumn clearance;  // all points but the nearest are at least this far away; 0: nothing is known
  Indices order, nearest;   // of those who ask by row

  explicit FollowedPoints(std::size_t size)
      : row(size, std::numeric_limits<double>::infinity()),
        second(size, std::numeric_limits<double>::infinity()),
        clearance(size, 0) {
    target_rows.resize(size);
    for (int axis = 0; axis < 3; ++axis) {
      source[axis].assign(size, std::numeric_limits<double>::infinity());
      target[axis].assign(size, std::numeric_limits<double>::infinity());
      was[axis].assign(size, 0);
    }
  }
};

/// Finds the partners of the places first .. last - 1, in whole registers, where it is not sure that they are as before.
void search_partners(const PointTree& tree, FollowedPoints& followed, std::size_t first, std::size_t last,
                     double limit);

}  // namespace corral
