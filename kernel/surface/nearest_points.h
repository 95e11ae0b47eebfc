// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "kernel/types.h"
#include "kernel/vectorized.h"

namespace corral {

/// A tree of boxes over a fixed set of points, eight to a node, so that a register looks at all of a node at once. For
/// queries that lie anywhere; where the queries are the points themselves, PointGrid is the index of choice.
class PointTree {
 public:
  /// Rows that are not finite are never found.
  explicit PointTree(const Points& points);

 private:
  friend class NearestTracker;
  struct Node {  // of an entry that is not there, all places are infinite
    double low[3][kLanes], high[3][kLanes];
    int child[kLanes];  // a node, or the number of a leaf
  };
  struct Leaf {
    double place[3][kLanes];
    double row[kLanes];  // infinite where there is no point
  };
  static constexpr int kNothing = -1;  // leaves have the numbers below
  static int leaf_number(std::size_t index) { return -2 - static_cast<int>(index); }
  static std::size_t leaf_index(int number) { return static_cast<std::size_t>(-2 - number); }

  struct Item;
  int add(Item* first, Item* last, Node& boxes, int entry);
  int add_leaf(const Item* first, const Item* last, Node& boxes, int entry);
  void divide(Item* first, Item* last, std::ptrdiff_t share, Node& node, int& entries);

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  int root_ = kNothing;
};

/// Follows the nearest points of queries that move little from one call to the next, as in iterative closest points.
///
///   nearest(i) = argmin_v |q_i - v| over the points with |q_i - v| <= limit, the lowest row of several
///
/// The answer is exact and does not depend on the calls before; they only save time. If all points but v were at least c
/// away from a query that has moved by d since, they are at least c - d away: while |q - v| < c - d, v remains the nearest,
/// and nothing is searched. Otherwise queries that lie next to each other are searched together, one in each lane.
///
/// Source    the bound is that of [greenspan2001nearest], with one distance in place of sorted lists of neighbours.
/// Cost      one comparison where the bound holds; a search visits O(log V) nodes, and few for a query beyond the limit.
class NearestTracker {
 public:
  /// The tree must outlive this.
  explicit NearestTracker(const PointTree& tree);
  ~NearestTracker();

  /// For each query (N x 3) the row of the nearest point, or -1 if none lies within the limit (inclusive, units of the
  /// points) or the query is not finite. Valid until the next call.
  const Indices& nearest(const Points& queries, double limit);

 private:
  struct Group;  // eight queries that lie next to each other
  template <class Lanes>
  struct Search;
  static std::vector<Group> make_groups(const Points& queries);

  const PointTree& tree_;
  std::map<std::size_t, std::vector<Group>> groups_;  // by the number of queries: those of each level of a refinement
  Indices nearest_;
};

}  // namespace corral
