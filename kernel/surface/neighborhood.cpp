// SPDX-License-Identifier: MIT
#include "kernel/surface/neighborhood.h"

#include <CGAL/Fuzzy_sphere.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace corral {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using PointMap = CGAL::Pointer_property_map<Point>::const_type;
using Traits = CGAL::Search_traits_adapter<std::size_t, PointMap, CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
using Sphere = CGAL::Fuzzy_sphere<Traits>;

Point to_cgal(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

std::vector<std::size_t> first_integers(std::size_t count) {
  std::vector<std::size_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = i;
  return values;
}

}  // namespace

struct PointIndex::Tree {
  std::vector<Point> points;
  PointMap map;
  Search::Distance distance;
  Search::Tree tree;

  static std::vector<Point> copy(const Points& points) {
    std::vector<Point> copied;
    copied.reserve(static_cast<std::size_t>(points.rows()));
    for (Eigen::Index row = 0; row < points.rows(); ++row) copied.push_back(to_cgal(points.row(row).transpose()));
    return copied;
  }

  explicit Tree(const Points& input)
      : points(copy(input)),
        map(CGAL::make_property_map(std::as_const(points).data())),
        distance(map),
        tree(Search::Tree::Splitter(), Traits(map)) {
    if (points.empty()) return;  // a tree over nothing cannot be built, and is never asked
    const auto indices = first_integers(points.size());
    tree.insert(indices.begin(), indices.end());
    tree.build();
  }

  Neighbor measure(const Eigen::Vector3d& query, std::size_t index) const {
    const Point& point = points[index];
    const double x = point.x() - query.x(), y = point.y() - query.y(), z = point.z() - query.z();
    return {static_cast<int>(index), x * x + y * y + z * z};
  }
};

PointIndex::PointIndex(const Points& points) : tree_(std::make_unique<Tree>(points)) {}
PointIndex::~PointIndex() = default;

std::vector<Neighbor> PointIndex::within(const Eigen::Vector3d& center, double radius) const {
  std::vector<Neighbor> neighbors;
  if (!(radius >= 0) || !std::isfinite(radius) || tree_->points.empty()) return neighbors;
  // The tree decides with its own arithmetic: ask for a little more and decide here.
  const double generous = radius * (1 + 1e-9) + std::numeric_limits<double>::min();
  std::vector<std::size_t> found;
  tree_->tree.search(std::back_inserter(found), Sphere(to_cgal(center), generous, 0.0, Traits(tree_->map)));
  neighbors.reserve(found.size());
  for (const std::size_t index : found) {
    const Neighbor neighbor = tree_->measure(center, index);
    if (neighbor.squared_distance <= radius * radius) neighbors.push_back(neighbor);
  }
  std::sort(neighbors.begin(), neighbors.end(), [](const Neighbor& a, const Neighbor& b) { return a.index < b.index; });
  return neighbors;
}

std::vector<Neighbor> PointIndex::nearest(const Eigen::Vector3d& query, int count) const {
  std::vector<Neighbor> neighbors;
  const auto wanted = std::min(static_cast<std::size_t>(std::max(count, 0)), tree_->points.size());
  if (wanted == 0) return neighbors;
  // One more than asked: if it is as far as the last, others may be too, and the lowest indices must win.
  const auto asked = static_cast<unsigned>(std::min(wanted + 1, tree_->points.size()));
  const Search search(tree_->tree, to_cgal(query), asked, 0.0, true, tree_->distance);
  for (const auto& [index, squared] : search) neighbors.push_back(tree_->measure(query, index));
  const auto nearer = [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance || (a.squared_distance == b.squared_distance && a.index < b.index);
  };
  std::sort(neighbors.begin(), neighbors.end(), nearer);
  if (neighbors.size() > wanted && !(neighbors[wanted - 1].squared_distance < neighbors[wanted].squared_distance)) {
    neighbors = within(query, std::sqrt(neighbors[wanted].squared_distance) * (1 + 1e-15));
    std::sort(neighbors.begin(), neighbors.end(), nearer);
  }
  if (neighbors.size() > wanted) neighbors.resize(wanted);
  return neighbors;
}

}  // namespace corral
