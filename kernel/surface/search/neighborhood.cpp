// SPDX-License-Identifier: MIT
#include "kernel/surface/search/neighborhood.h"

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

#include "kernel/surface/mesh/mesh.h"

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

bool is_nearer(const Neighbor& a, const Neighbor& b) {
  return a.squared_distance < b.squared_distance || (a.squared_distance == b.squared_distance && a.index < b.index);
}

}  // namespace

/// Holds every place once: CGAL's tree would be as deep as the largest number of points in one place, and recurse as deep.
struct PointIndex::Tree {
  Indices rows;
  std::vector<std::size_t> begins;  // of the rows in each place
  std::vector<Point> places;
  PointMap map;
  Search::Distance distance;
  Search::Tree tree;

  explicit Tree(const Points& input)
      : rows(rows_by_place(input)),
        places(collect(input)),
        map(CGAL::make_property_map(std::as_const(places).data())),
        distance(map),
        tree(Search::Tree::Splitter(), Traits(map)) {
    if (places.empty()) return;  // an empty tree cannot be built, and is never queried
    const auto indices = first_integers(places.size());
    tree.insert(indices.begin(), indices.end());
    tree.build();
  }

  std::vector<Point> collect(const Points& input) {
    std::vector<Point> distinct;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Point point = to_cgal(input.row(rows[i]).transpose());
      if (!distinct.empty() && point == distinct.back()) continue;
      distinct.push_back(point);
      begins.push_back(i);
    }
    begins.push_back(rows.size());
    return distinct;
  }

  double squared_distance(const Eigen::Vector3d& query, std::size_t place) const {
    const Point& point = places[place];
    const double x = point.x() - query.x(), y = point.y() - query.y(), z = point.z() - query.z();
    return x * x + y * y + z * z;
  }

  /// Adds the points in a place, at most so many.
  void add(std::size_t place, double squared, std::size_t most, std::vector<Neighbor>& neighbors) const {
    const std::size_t end = std::min(begins[place + 1], begins[place] + most);
    for (std::size_t i = begins[place]; i < end; ++i) neighbors.push_back({rows[i], squared});
  }
};

PointIndex::PointIndex(const Points& points) : tree_(std::make_unique<Tree>(points)) {}
PointIndex::~PointIndex() = default;

std::vector<Neighbor> PointIndex::within(const Eigen::Vector3d& center, double radius) const {
  std::vector<Neighbor> neighbors;
  if (!(radius >= 0) || !std::isfinite(radius) || tree_->places.empty()) return neighbors;
  // The tree decides with its own arithmetic: query a little more and decide here.
  const double generous = radius * (1 + 1e-9) + std::numeric_limits<double>::min();
  std::vector<std::size_t> found;
  tree_->tree.search(std::back_inserter(found), Sphere(to_cgal(center), generous, 0.0, Traits(tree_->map)));
  neighbors.reserve(found.size());
  for (const std::size_t place : found) {
    const double squared = tree_->squared_distance(center, place);
    if (squared <= radius * radius) tree_->add(place, squared, tree_->rows.size(), neighbors);
  }
  std::sort(neighbors.begin(), neighbors.end(), [](const Neighbor& a, const Neighbor& b) { return a.index < b.index; });
  return neighbors;
}

std::vector<Neighbor> PointIndex::nearest(const Eigen::Vector3d& query, int count) const {
  std::vector<Neighbor> neighbors;
  const auto wanted = std::min(static_cast<std::size_t>(std::max(count, 0)), tree_->rows.size());
  if (wanted == 0) return neighbors;
  // One place more than asked: if it is as far as the last, others may be too, and the lowest indices must win.
  const auto asked = std::min(wanted + 1, tree_->places.size());
  const Search search(tree_->tree, to_cgal(query), static_cast<unsigned>(asked), 0.0, true, tree_->distance);
  double farthest = 0;
  for (const auto& [place, by_tree] : search) {
    const double squared = tree_->squared_distance(query, place);
    farthest = std::max(farthest, squared);
    tree_->add(place, squared, wanted, neighbors);
  }
  std::sort(neighbors.begin(), neighbors.end(), is_nearer);
  if (asked < tree_->places.size() && !(neighbors[wanted - 1].squared_distance < farthest)) {
    neighbors = within(query, std::sqrt(farthest) * (1 + 1e-15));
    std::sort(neighbors.begin(), neighbors.end(), is_nearer);
  }
  neighbors.resize(wanted);
  return neighbors;
}

}  // namespace corral
