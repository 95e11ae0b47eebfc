// SPDX-License-Identifier: MIT
#include "kernel/surface/search/mean_nearest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "kernel/error.h"
#include "kernel/surface/search/far_groups.h"
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

/// Strays are further than this from all others, in medians of all distances.
constexpr double kStrayMedians = 20;

double median_of_distinct(const PointGrid& grid, const AlignedColumn& squares) {
  std::vector<double> distinct;
  distinct.reserve(static_cast<std::size_t>(grid.size()));
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(grid.size()); ++slot)
    if (!is_duplicate(grid, slot)) distinct.push_back(squares[slot]);
  const auto middle = distinct.begin() + static_cast<std::ptrdiff_t>(distinct.size() / 2);
  std::nth_element(distinct.begin(), middle, distinct.end());
  return std::sqrt(*middle);
}

/// Fills in which vertices are strays, and the spacing of the others.
void tell_strays(const PointGrid& grid, const AlignedColumn& squares, double largest, PointSpacing& spacing) {
  constexpr double kFew = 0.02;
  spacing.without_strays = spacing.resolution;
  const double limit = kStrayMedians * spacing.median;
  int places = 0, strays = 0;
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(grid.size()); ++slot) {
    if (is_duplicate(grid, slot)) continue;
    ++places;
    strays += squares[slot] > limit * limit;
  }
  const int few = static_cast<int>(kFew * places);
  const FarGroups groups = far_groups(grid, squares, limit, few - strays);
  if (strays > 0) spacing.stray_distance = std::sqrt(largest);
  spacing.stray_distance = std::max(spacing.stray_distance, groups.distance);
  strays += static_cast<int>(groups.slots.size());
  if (strays == 0) return;
  double sum = 0;  // in the order of the slots, which does not depend on the threads
  bool is_stray = false;
  auto grouped = groups.slots.begin();
  for (int slot = 0; slot < grid.size(); ++slot) {
    const auto i = static_cast<std::size_t>(slot);
    const bool repeats = is_duplicate(grid, i);
    if (!repeats) {
      const bool is_grouped = grouped != groups.slots.end() && *grouped == slot;
      grouped += is_grouped;
      is_stray = is_grouped || squares[i] > limit * limit;
    }
    if (is_stray) spacing.strays.push_back(grid.row(slot));
    if (!repeats && !is_stray) sum += std::sqrt(squares[i]);
  }
  std::sort(spacing.strays.begin(), spacing.strays.end());
  if (strays <= few) spacing.without_strays = sum / (places - strays);
}

}  // namespace

bool PointSpacing::is_moved_by_strays() const { return resolution > 1.05 * without_strays; }

PointSpacing mean_nearest(const PointGrid& grid, const Points& points, AlignedColumn squares) {
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
  PointSpacing spacing;
  spacing.resolution = spacing.median = spacing.without_strays = kInfinity;
  if (!(largest < kInfinity)) return spacing;
  // In whole numbers of a unit below the last place of the longest, which add up to the same in whatever order.
  __extension__ typedef __int128 Wide;
  const double units = std::ldexp(1, 61 - std::ilogb(std::sqrt(largest)));  // in 1
  Wide total = 0;
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(grid.size()); ++slot)
    total += static_cast<std::int64_t>(std::sqrt(squares[slot]) * units);
  spacing.resolution = static_cast<double>(total) / units / distinct;
  spacing.median = median_of_distinct(grid, squares);
  tell_strays(grid, squares, largest, spacing);
  return spacing;
}

}  // namespace corral
