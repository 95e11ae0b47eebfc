// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/surface/search/point_grid.h"

namespace corral {

/// Two or three places that lie beside each other and far from all others: a vertex has its nearest in its own group.
struct FarGroups {
  std::vector<int> slots;  ///< of their places, ascending; of duplicates the first
  double distance = 0;     ///< the largest of a place to the nearest one outside of its group
};

/// Groups whose places are joined by steps of at most `limit`, and are further than that from all others. `squares`: by slot,
/// the squared distance to the nearest other place. None at all if they have more than `most` places. Only sources include
/// this.
///
/// Cost      A small share of a search for the nearest where points lie on a surface: there no cell needs a closer look.
/// Plain form  tests/support/reference/surface.h
FarGroups far_groups(const PointGrid& grid, const AlignedColumn& squares, double limit, int most);

}  // namespace corral
