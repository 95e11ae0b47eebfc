// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "kernel/columns.h"
#include "kernel/parallel.h"
#include "kernel/point_pairs.h"
#include "kernel/types.h"

namespace corral {

/// A tree of boxes over a fixed set of points, eight to a node, so that one vector operation tests all of a node. For
/// queries anywhere; where the queries are the points themselves, PointGrid is faster.
class PointTree {
 public:
  /// Rows that are not finite are never found.
  explicit PointTree(const Points& points, const ParallelFor& parallel = one_by_one);

  struct alignas(64) Node {  // an absent entry has infinite coordinates
    double low[3][kLanes], high[3][kLanes];
    int child[kLanes];  // a node, or the number of a leaf
  };
  struct alignas(64) Leaf {
    double place[3][kLanes];
    double row[kLanes];  // infinite where there is no point
  };
  static constexpr int kNothing = -1;  // leaves have the numbers below
  static int leaf_number(std::size_t index) { return -2 - static_cast<int>(index); }
  static std::size_t leaf_index(int number) { return static_cast<std::size_t>(-2 - number); }

  /// What a search reads. Only sources call these.
  const Node* nodes() const { return nodes_.data(); }
  const Leaf* leaves() const { return leaves_.data(); }
  int root() const { return root_; }           ///< a node, the number of a leaf, or kNothing
  double spacing() const { return spacing_; }  ///< about the distance of neighbours, where the points lie on a surface

 private:
  struct Box;
  std::vector<Box> gather(const std::vector<Box>& boxes);

  std::vector<Node, CacheLineAllocator<Node>> nodes_;
  std::vector<Leaf, CacheLineAllocator<Leaf>> leaves_;
  int root_ = kNothing;
  double spacing_ = 0;
};

struct FollowedPoints;

/// Follows the nearest points of queries that move little from one call to the next, as in iterative closest points.
///
///   nearest(i) = argmin_v |q_i - v| over the points with |q_i - v| <= limit, the lowest row of several
///
/// The result is exact and does not depend on earlier calls; they only save time. If all points but v were at least c away
/// from a query that has moved by d since, they are at least c - d away: while |q - v| < c - d, v remains the nearest, and
/// no search is needed. Otherwise neighbouring queries are searched together, one in each lane.
///
/// Source    the bound is that of [greenspan2001nearest], with one distance in place of sorted lists of neighbours.
/// Cost      one comparison where the bound holds; a search visits O(log V) nodes, and few for a query beyond the limit.
/// Plain form  tests/support/reference/surface.h
class NearestTracker {
 public:
  /// The tree must outlive this.
  explicit NearestTracker(const PointTree& tree, ParallelFor parallel = one_by_one);
  ~NearestTracker();

  /// Each query (N x 3) with the nearest point, if one lies within the limit (inclusive, units of the points) and the query
  /// is finite. Valid until the next call. Fast if consecutive queries lie close together (spatial_order).
  const PointPairs& pair(const Points& queries, double limit);

  /// The rows of those points, -1 where there is none; fast in any order. Valid until the next call.
  const Indices& nearest(const Points& queries, double limit);

 private:
  FollowedPoints& follow(Eigen::Index count);

  const PointTree& tree_;
  ParallelFor parallel_;
  std::map<Eigen::Index, FollowedPoints> followed_;  // by the number of queries: those of each level of a refinement
};

}  // namespace corral
