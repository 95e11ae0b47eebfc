// SPDX-License-Identifier: MIT
#include "kernel/surface/search/far_groups.h"

#include <algorithm>
#include <cmath>

#include "kernel/surface/search/neighborhood.h"

namespace corral {
namespace {

constexpr int kMostTogether = 3;

/// Looks cell by cell for places that may have fewer than kMostTogether others within the limit.
class Search {
 public:
  Search(const PointGrid& grid, const AlignedColumn& squares, double limit)
      : grid_(grid), squares_(squares), squared_limit_(limit * limit) {
    constexpr double kDiagonal = 1.75;  // of a cube, rounded up
    const double diagonal = kDiagonal * grid.cell_side();
    // All places in the cells up to `reach` from its own are within the limit of a place.
    const int reach = static_cast<int>(std::min(limit / diagonal, 1.0 + PointGrid::kLargestReach)) - 1;
    CellSweep next_cells(grid, 1), cells_within(grid, std::max(reach, 1));
    std::vector<SlotRange> ranges;
    const auto many_around = [&](CellSweep& sweep, int cell) {
      ranges.clear();
      sweep.around(cell, ranges);
      return has_many(ranges);
    };
    for (int cell = 0; cell < grid.cells(); ++cell) {
      const SlotRange own{grid.begin(cell), grid.end(cell)};
      if (reach >= 0 && has_many({own})) continue;
      if (reach >= 1 && (many_around(next_cells, cell) || many_around(cells_within, cell))) continue;
      for (int slot = own.begin; slot < own.end; ++slot)
        if (is_first(slot) && at(squares_, slot) <= squared_limit_ && !has_many_near(slot, own)) found_.push_back(slot);
    }
  }

  /// Leaves out those that have others, as far as it takes no longer than to build a tree.
  void look_at_all() {
    constexpr double kMostWork = 1e7;  // distances
    if (static_cast<double>(found_.size()) * grid_.size() > kMostWork) return;
    const auto has_others = [&](int slot) { return has_many_near(slot, {0, grid_.size()}); };
    found_.erase(std::remove_if(found_.begin(), found_.end(), has_others), found_.end());
  }

  const std::vector<int>& found() const { return found_; }
  bool is_first(int slot) const { return slot == 0 || !are_equal(slot, slot - 1); }
  Eigen::RowVector3d place(int slot) const { return {at(grid_.x(), slot), at(grid_.y(), slot), at(grid_.z(), slot)}; }

 private:
  static double at(const AlignedColumn& column, int slot) { return column[static_cast<std::size_t>(slot)]; }
  bool are_equal(int a, int b) const {
    return at(grid_.x(), a) == at(grid_.x(), b) && at(grid_.y(), a) == at(grid_.y(), b) &&
           at(grid_.z(), a) == at(grid_.z(), b);
  }

  bool has_many(const std::vector<SlotRange>& ranges) const {
    int places = 0;
    for (const SlotRange& range : ranges)
      for (int slot = range.begin; slot < range.end && places <= kMostTogether; ++slot) places += is_first(slot);
    return places > kMostTogether;
  }

  bool has_many_near(int slot, const SlotRange& own) const {
    int near = 0;
    for (int other = own.begin; other < own.end && near <= kMostTogether; ++other)
      near += is_first(other) && (place(other) - place(slot)).squaredNorm() <= squared_limit_;
    return near > kMostTogether;
  }

  const PointGrid& grid_;
  const AlignedColumn& squares_;
  const double squared_limit_;
  std::vector<int> found_;
};

/// The group of a place, by rows of the index, or nothing if it has too many.
std::vector<int> group_of(int row, const PointIndex& index, const Points& places, double squared_limit) {
  std::vector<int> group{row};
  for (std::size_t next = 0; next < group.size(); ++next)
    for (const Neighbor& neighbor : index.nearest(places.row(group[next]).transpose(), kMostTogether + 1)) {
      if (!(neighbor.squared_distance <= squared_limit)) break;
      if (std::find(group.begin(), group.end(), neighbor.index) != group.end()) continue;
      group.push_back(neighbor.index);
      if (group.size() > kMostTogether) return {};
    }
  return group;
}

double distance_from_group(int row, const std::vector<int>& group, const PointIndex& index, const Points& places) {
  for (const Neighbor& neighbor : index.nearest(places.row(row).transpose(), static_cast<int>(group.size()) + 1))
    if (std::find(group.begin(), group.end(), neighbor.index) == group.end())
      return std::sqrt(neighbor.squared_distance);
  return 0;
}

}  // namespace

FarGroups far_groups(const PointGrid& grid, const AlignedColumn& squares, double limit, int most) {
  FarGroups groups;
  if (most < 2) return groups;
  Search search(grid, squares, limit);
  search.look_at_all();
  if (search.found().empty()) return groups;
  std::vector<int> firsts;
  for (int slot = 0; slot < grid.size(); ++slot)
    if (search.is_first(slot)) firsts.push_back(slot);
  Points places(static_cast<Eigen::Index>(firsts.size()), 3);
  for (std::size_t row = 0; row < firsts.size(); ++row)
    places.row(static_cast<Eigen::Index>(row)) = search.place(firsts[row]);
  const PointIndex index(places);
  for (const int slot : search.found()) {
    const int row = static_cast<int>(std::lower_bound(firsts.begin(), firsts.end(), slot) - firsts.begin());
    const std::vector<int> group = group_of(row, index, places, limit * limit);
    if (group.empty()) continue;
    groups.slots.push_back(slot);
    if (static_cast<int>(groups.slots.size()) > most) return {};
    groups.distance = std::max(groups.distance, distance_from_group(row, group, index, places));
  }
  return groups;
}

}  // namespace corral
