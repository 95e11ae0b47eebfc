// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/surface/support.h"

namespace corral {

// The loops over the support of a point. Only sources include this.
// Plain form  tests/support/reference/shot.h

/// x, y, z, the three of the normal, and the rows, by slot; the last may be null.
struct SlotColumns {
  const double* column[7];
};

/// Makes the support of a slot those of some ranges that lie within a squared distance, all but their distances.
void collect_support(const SlotColumns& from, std::size_t slot, double squared, const std::vector<SlotRange>& ranges,
                     Support& support);

/// The distances of the support, and of its padding.
void measure_support(Support& support);

/// Sums over a support with weights radius - distance.
struct WeightedMoments {
  double weights, xx, xy, xz, yy, yz, zz;
};
WeightedMoments sum_moments(const Support& support, double radius);

/// How many of the support lie ahead on each of two axes, or beside.
std::array<int, 2> count_ahead(const std::array<Eigen::Vector3d, 2>& axes, const Support& support);

}  // namespace corral
