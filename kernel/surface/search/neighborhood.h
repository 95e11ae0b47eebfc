// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "kernel/types.h"

namespace corral {

struct Neighbor {
  int index;                ///< row of the indexed points
  double squared_distance;  ///< to the query, squared units of the points
};

/// Exact neighbour queries over a fixed set of finite points (CGAL's kd-tree inside). Results do not depend on the tree:
/// ties go to the lower index.
class PointIndex {
 public:
  /// Keeps its own copy of the points.
  explicit PointIndex(const Points& points);
  ~PointIndex();
  PointIndex(const PointIndex&) = delete;
  PointIndex& operator=(const PointIndex&) = delete;

  /// All points with |x - center| <= radius, ascending by index. A radius that is not finite or below 0: none.
  std::vector<Neighbor> within(const Eigen::Vector3d& center, double radius) const;

  /// The `count` nearest points (all, if there are fewer), nearest first. A point at the query itself is its own nearest.
  std::vector<Neighbor> nearest(const Eigen::Vector3d& query, int count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace corral
