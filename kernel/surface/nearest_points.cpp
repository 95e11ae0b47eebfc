// SPDX-License-Identifier: MIT
#include "kernel/surface/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace corral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-11;  // of a few sums and roots, generously
constexpr double kSlack = 1.25;      // of the limit, so that queries just beyond it can move without a search
constexpr int kDeepest = 12;         // levels of eight entries: more than there are row numbers

}  // namespace

struct PointTree::Item {
  double place[3];
  int row;
};

PointTree::PointTree(const Points& points) {
  std::vector<Item> items;
  items.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    if (points.row(row).allFinite())
      items.push_back({{points(row, 0), points(row, 1), points(row, 2)}, static_cast<int>(row)});
  if (items.empty()) return;
  Node whole;
  root_ = add(items.data(), items.data() + items.size(), whole, 0);
}

/// A leaf or a node of some points; their box becomes an entry of another node.
int PointTree::add(Item* first, Item* last, Node& boxes, int entry) {
  if (last - first <= kLanes) return add_leaf(first, last, boxes, entry);
  std::ptrdiff_t share = kLanes;  // of an entry, so that all leaves but the last are full
  while (share * kLanes < last - first) share *= kLanes;
  Node node;
  int entries = 0;
  divide(first, last, share, node, entries);
  for (int axis = 0; axis < 3; ++axis) {
    boxes.low[axis][entry] = *std::min_element(node.low[axis], node.low[axis] + entries);
    boxes.high[axis][entry] = *std::max_element(node.high[axis], node.high[axis] + entries);
    std::fill(node.low[axis] + entries, node.low[axis] + kLanes, kInfinity);
    std::fill(node.high[axis] + entries, node.high[axis] + kLanes, kInfinity);
  }
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

int PointTree::add_leaf(const Item* first, const Item* last, Node& boxes, int entry) {
  Leaf leaf;
  const auto count = static_cast<int>(last - first);
  for (int axis = 0; axis < 3; ++axis) {
    double* place = leaf.place[axis];
    for (int i = 0; i < kLanes; ++i) place[i] = i < count ? first[i].place[axis] : kInfinity;
    boxes.low[axis][entry] = *std::min_element(place, place + count);
    boxes.high[axis][entry] = *std::max_element(place, place + count);
  }
  for (int i = 0; i < kLanes; ++i) leaf.row[i] = i < count ? first[i].row : kInfinity;
  leaves_.push_back(leaf);
  return leaf_number(leaves_.size() - 1);
}

/// Halves points across their longest extent until each part is one entry's share.
void PointTree::divide(Item* first, Item* last, std::ptrdiff_t share, Node& node, int& entries) {
  const std::ptrdiff_t parts = (last - first + share - 1) / share;
  if (parts == 1) {
    const int entry = entries++;
    node.child[entry] = add(first, last, node, entry);
    return;
  }
  double low[3], high[3];
  std::copy_n(first->place, 3, low);
  std::copy_n(first->place, 3, high);
  for (const Item* item = first; item != last; ++item)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item->place[axis]);
      high[axis] = std::max(high[axis], item->place[axis]);
    }
  int longest = 0;
  for (const int axis : {1, 2})
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  Item* const middle = first + share * (parts / 2);
  std::nth_element(first, middle, last,
                   [longest](const Item& a, const Item& b) { return a.place[longest] < b.place[longest]; });
  divide(first, middle, share, node, entries);
  divide(middle, last, share, node, entries);
}

/// Eight queries, and what was found for each where it was searched last.
struct alignas(64) NearestTracker::Group {
  int query[kLanes];          // row among the queries; -1: no query
  double place[3][kLanes];    // where the query was
  double nearest[3][kLanes];  // the nearest point; infinite if none was near enough
  double row[kLanes];         // of that point
  double second[kLanes];      // distance of the next nearest; infinite if none was near enough
  double clearance[kLanes];   // all points but the nearest are at least this far away; 0: nothing is known
};

/// The nearest of eight queries; lanes whose bound is negative are left alone.
template <class Lanes>
struct NearestTracker::Search {
  Lanes x, y, z, bound_squared;
  Lanes best, second, row, nearest_x, nearest_y, nearest_z;  // infinite at first

  struct Visit {
    double squared;
    int number;
  };

  CORRAL_INLINE void look_at(const PointTree::Leaf& leaf) {
    for (int i = 0; i < kLanes; ++i) {
      const Lanes px = Lanes::fill(leaf.place[0][i]), py = Lanes::fill(leaf.place[1][i]),
                  pz = Lanes::fill(leaf.place[2][i]), number = Lanes::fill(leaf.row[i]);
      const Lanes dx = x - px, dy = y - py, dz = z - pz, squared = dx * dx + dy * dy + dz * dz;
      second = smaller(second, larger(best, squared));
      // Of equally near ones the lowest row.
      const Lanes rank = select(squared == best, number, select(squared < best, Lanes::fill(-1), row));
      nearest_x = select(rank < row, px, nearest_x);
      nearest_y = select(rank < row, py, nearest_y);
      nearest_z = select(rank < row, pz, nearest_z);
      row = select(rank < row, number, row);
      best = smaller(best, squared);
    }
  }

  CORRAL_INLINE double bound() const { return -smallest(Lanes::fill(0) - smaller(second, bound_squared)); }

  /// Puts the entries of a node that are near enough on top of those that wait, the nearest last.
  CORRAL_INLINE void unfold(const PointTree::Node& node, const Lanes (&low)[3], const Lanes (&high)[3], double limit,
                            Visit* waiting, int& size) const {
    // Rounding is monotonic: the computed distance of two boxes is never above that of points in them.
    const auto gap = [&](int axis) {
      return larger(Lanes::fill(0),
                    larger(Lanes::load(node.low[axis]) - high[axis], low[axis] - Lanes::load(node.high[axis])));
    };
    const Lanes dx = gap(0), dy = gap(1), dz = gap(2);
    double squares[kLanes];
    (dx * dx + dy * dy + dz * dz).store(squares);
    const int before = size;
    for (int i = 0; i < kLanes; ++i) {
      if (!(squares[i] <= limit) || squares[i] == kInfinity) continue;
      int at = size++;
      for (; at > before && waiting[at - 1].squared < squares[i]; --at) waiting[at] = waiting[at - 1];
      waiting[at] = {squares[i], node.child[i]};
    }
  }

  /// The box holds the lanes that are searched.
  CORRAL_INLINE void run(const PointTree& tree, const double* box_low, const double* box_high) {
    const Lanes low[3] = {Lanes::fill(box_low[0]), Lanes::fill(box_low[1]), Lanes::fill(box_low[2])},
                high[3] = {Lanes::fill(box_high[0]), Lanes::fill(box_high[1]), Lanes::fill(box_high[2])};
    Visit waiting[kDeepest * kLanes];
    int size = 0;
    if (tree.root_ != PointTree::kNothing) waiting[size++] = {0, tree.root_};
    double limit = bound();
    while (size > 0) {
      const Visit visit = waiting[--size];
      if (visit.squared > limit) continue;
      if (visit.number < 0) {
        look_at(tree.leaves_[PointTree::leaf_index(visit.number)]);
        limit = bound();
      } else {
        unfold(tree.nodes_[static_cast<std::size_t>(visit.number)], low, high, limit, waiting, size);
      }
    }
  }
};

NearestTracker::NearestTracker(const PointTree& tree) : tree_(tree) {}
NearestTracker::~NearestTracker() = default;

/// The leaves of a tree over the queries hold neighbours; then come those that no tree takes.
std::vector<NearestTracker::Group> NearestTracker::make_groups(const Points& queries) {
  const PointTree order(queries);
  Group empty{};
  std::fill_n(empty.query, kLanes, -1);
  std::fill_n(empty.second, kLanes, kInfinity);
  std::vector<Group> groups(order.leaves_.size(), empty);
  for (std::size_t leaf = 0; leaf < groups.size(); ++leaf)
    for (int i = 0; i < kLanes; ++i)
      if (order.leaves_[leaf].row[i] < kInfinity) groups[leaf].query[i] = static_cast<int>(order.leaves_[leaf].row[i]);
  int lane = kLanes;
  for (Eigen::Index row = 0; row < queries.rows(); ++row) {
    if (queries.row(row).allFinite()) continue;
    if (lane == kLanes) groups.push_back(empty), lane = 0;
    groups.back().query[lane++] = static_cast<int>(row);
  }
  return groups;
}

const Indices& NearestTracker::nearest(const Points& queries, double limit) {
  const auto count = static_cast<std::size_t>(queries.rows());
  const auto [place_of, is_new] = groups_.try_emplace(count);
  if (is_new) place_of->second = make_groups(queries);
  std::vector<Group>& groups = place_of->second;
  nearest_.assign(count, -1);
  const double limit_squared = limit * limit, farthest = kSlack * limit;

  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    const Lanes zero = Lanes::fill(0), none = Lanes::fill(kInfinity);
    alignas(64) double place[3][kLanes] = {}, bounds[kLanes], squares[kLanes];

    for (Group& group : groups) {
      double low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
      bool is_finite[kLanes], must_search = false;
      for (int i = 0; i < kLanes; ++i) {
        const Eigen::Index row = std::max(group.query[i], 0);
        const double x = queries(row, 0), y = queries(row, 1), z = queries(row, 2);
        is_finite[i] = group.query[i] >= 0 && std::isfinite(x + y + z);
        place[0][i] = x, place[1][i] = y, place[2][i] = z;
      }
      const Lanes x = Lanes::load(place[0]), y = Lanes::load(place[1]), z = Lanes::load(place[2]);
      const auto squared_from = [&](const double(&other)[3][kLanes]) {
        const Lanes dx = x - Lanes::load(other[0]), dy = y - Lanes::load(other[1]), dz = z - Lanes::load(other[2]);
        return dx * dx + dy * dy + dz * dz;
      };
      const Lanes moved = square_root(squared_from(group.place));
      const Lanes sure = larger(zero, Lanes::load(group.clearance) * Lanes::fill(1 - kRounding) - moved);
      // The second nearest is not farther than before by more than the motion.
      const Lanes reach =
          smaller(Lanes::fill(farthest), (Lanes::load(group.second) + moved) * Lanes::fill(1 + kRounding));
      select(smaller(squared_from(group.nearest), Lanes::fill(limit_squared)) < sure * sure, Lanes::fill(-1),
             reach * reach)
          .store(bounds);
      for (int i = 0; i < kLanes; ++i) {
        if (!is_finite[i]) bounds[i] = -1;
        if (!(bounds[i] >= 0)) continue;
        must_search = true;
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], place[axis][i]);
          high[axis] = std::max(high[axis], place[axis][i]);
        }
      }
      if (must_search) {
        Search<Lanes> search{x, y, z, Lanes::load(bounds), none, none, none, none, none, none};
        search.run(tree_, low, high);
        const Lanes bound = search.bound_squared;
        const auto keep = [&](const Lanes& found, double* to) {
          select(bound < zero, Lanes::load(to), found).store(to);
        };
        for (int axis = 0; axis < 3; ++axis) keep(Lanes::load(place[axis]), group.place[axis]);
        keep(search.nearest_x, group.nearest[0]);
        keep(search.nearest_y, group.nearest[1]);
        keep(search.nearest_z, group.nearest[2]);
        keep(search.row, group.row);
        keep(square_root(search.second), group.second);
        keep(square_root(smaller(search.second, larger(bound, zero))), group.clearance);
      }
      squared_from(group.nearest).store(squares);
      for (int i = 0; i < kLanes; ++i)
        if (is_finite[i] && squares[i] <= limit_squared && group.row[i] < kInfinity)
          nearest_[static_cast<std::size_t>(group.query[i])] = static_cast<int>(group.row[i]);
    }
  });
  return nearest_;
}

}  // namespace corral
