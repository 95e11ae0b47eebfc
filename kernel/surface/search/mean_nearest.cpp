// SPDX-License-Identifier: MIT
#include "kernel/surface/search/mean_nearest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "kernel/error.h"
#include "kernel/surface/search/neighborhood.h"

namespace corral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Duplicates are next to each other in the order of the slots.
bool is_duplicate(const PointGrid& grid, std::size_t slot) {
  return slot > 0 && grid.x()[slot] == grid.x()[slot - 1] && grid.y()[slot] == grid.y()[slot - 1] &&
         grid.z()[slot] == grid.z()[slot - 1];
}

/// Squared distance of a point to the nearest in another place, by CGAL's tree: for points that lie so that cells do not
/// help.
double nearest_by_tree(const PointIndex& index, const Eigen::Vector3d& point, int size) {
  for (int count = 2;; count *= 2) {
    for (const Neighbor& neighbor : index.nearest(point, count))
      if (neighbor.squared_distance > 0) return neighbor.squared_distance;
    if (count >= size) return kInfinity;
  }
}

}  // namespace

double mean_nearest(const PointGrid& grid, const Points& points, AlignedColumn squares) {
  std::optional<PointIndex> index;
  double largest = 0;
  int distinct = 0;
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(grid.size()); ++slot) {
    if (is_duplicate(grid, slot)) {  // thousands of them would take minutes
      squares[slot] = 0;
      continue;
    }
    if (!(squares[slot] < kInfinity)) {
      if (!index) index.emplace(points);
      squares[slot] = nearest_by_tree(*index, points.row(grid.row(static_cast<int>(slot))).transpose(), grid.size());
    }
    largest = std::max(largest, squares[slot]);
    ++distinct;
  }
  if (distinct < 2)
    throw InvalidInput("point_resolution", "number of distinct vertices", std::to_string(distinct),
                       "at least 2 (resolution would be zero)");
  if (!(largest < kInfinity)) return kInfinity;
  // In whole numbers of a unit below the last place of the longest, which add up to the same in whatever order.
  __extension__ typedef __int128 Wide;
  const double units = std::ldexp(1, 61 - std::ilogb(std::sqrt(largest)));  // in 1
  Wide total = 0;
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(grid.size()); ++slot)
    total += static_cast<std::int64_t>(std::sqrt(squares[slot]) * units);
  return static_cast<double>(total) / units / distinct;
}

}  // namespace corral
