// SPDX-License-Identifier: MIT
#pragma once

// Points that lie as indices of points do not like them.

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/types.h"

namespace corral::testing {

/// In the cube [-1, 1]^3.
Points uniform_points(int count, std::uint64_t seed);

/// Clusters of sizes from 1 down to 1e-4, some units apart.
Points clustered_points(int count, std::uint64_t seed);

/// Places with whole coordinates: distances between them tie in great numbers, and are exact.
Points lattice(int side);

/// One above the other.
Points stacked(const std::vector<Points>& parts);

struct PointSet {
  std::string name;
  Points points;
  double unit;  ///< about the distance of neighbours
};

/// Some hundred points at most each: in clusters, on lattices, in one place, on a line, far outliers, hardly any.
std::vector<PointSet> hard_point_sets();

}  // namespace corral::testing
