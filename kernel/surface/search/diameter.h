// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/types.h"

namespace corral {

/// The largest distance between two of the points (finite, any units), exact; 0 for fewer than two. Does not depend on
/// their order.
///
/// Cost      a tree of boxes, pairs of which are dropped where even their farthest corners are no farther apart than two
///           points already are: about O(V log V) for surfaces, O(V^1.5) for points on a sphere.
double diameter(const Points& points);

}  // namespace corral
