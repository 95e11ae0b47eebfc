// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/topology.h"

#include <algorithm>
#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/fans.h"
#include "kernel/surface/mesh/sides.h"

namespace corral {
namespace {

bool is_degenerate(const Mesh& mesh, Eigen::Index face) {
  const int a = mesh.triangles(face, 0), b = mesh.triangles(face, 1), c = mesh.triangles(face, 2);
  if (a == b || b == c || c == a) return true;
  return !(triangle_area(mesh.vertices.row(a), mesh.vertices.row(b), mesh.vertices.row(c)) > 0);
}

/// The triangles of a mesh without degenerate ones, wound alike and joined. They are copied only if any must change.
class SoundTriangles {
 public:
  explicit SoundTriangles(const Mesh& mesh) : given_(mesh.triangles) {
    Indices sound;
    for (int face = 0; face < static_cast<int>(given_.rows()); ++face) degenerate_ += is_degenerate(mesh, face);
    if (degenerate_ > 0) {
      for (int face = 0; face < static_cast<int>(given_.rows()); ++face)
        if (!is_degenerate(mesh, face)) sound.push_back(face);
      changed_ = given_(sound, Eigen::all);
    }
    Indices across = sides_across(triangles(), mesh.vertices.rows());
    const Indices against = wound_against_majority(triangles(), across);
    reversed_ = static_cast<int>(against.size());
    if (reversed_ > 0) {
      if (!changed_) changed_ = given_;
      for (const int face : against) std::swap((*changed_)(face, 1), (*changed_)(face, 2));
      across = sides_across(*changed_, mesh.vertices.rows());
    }
    joined_ = join_triangles(triangles(), std::move(across), mesh.vertices.rows());
  }

  const Triangles& triangles() const { return changed_ ? *changed_ : given_; }
  const JoinedTriangles& joined() const { return joined_; }
  int degenerate() const { return degenerate_; }
  int reversed() const { return reversed_; }

  /// Calls visit(side) once for each edge, in the order in which the triangles first name them.
  template <class Visitor>
  void visit_edges(Visitor&& visit) const {
    constexpr int kFaces = 256;
    const Ends ends(triangles());
    std::array<int, 3 * kFaces> block;  // gathered first: which side is first to name an edge, no processor can guess
    for (int face = 0; face < ends.faces();) {
      std::size_t count = 0;
      for (const int behind = std::min(ends.faces(), face + kFaces); face < behind; ++face)
        for (const int side : ends.sides_of(face)) {
          const int other = joined_.across[index(side)];
          block[count] = side;
          count += other == kNoSide || (other >= 0 && face < ends.face(other));
        }
      for (std::size_t i = 0; i < count; ++i) visit(block[i]);
    }
  }

 private:
  const Triangles& given_;
  std::optional<Triangles> changed_;
  JoinedTriangles joined_;
  int degenerate_ = 0, reversed_ = 0;
};

/// Parts that share no vertex.
int count_components(const Ends& ends, const Indices& across, Eigen::Index vertices) {
  Indices rank(static_cast<std::size_t>(vertices)), parent(rank.size(), kNoSide);
  boost::disjoint_sets<int*, int*> sets(rank.data(), parent.data());
  int components = 0;
  for (int face = 0; face < ends.faces(); ++face) {
    if (across[index(face)] == kLeftOut) continue;
    int first = kNoSide;
    for (const int side : ends.sides_of(face)) {
      const int vertex = ends.from(side);
      if (parent[index(vertex)] == kNoSide) sets.make_set(vertex), ++components;
      const int other = sets.find_set(vertex);
      if (first == kNoSide) first = other;
      if (first == other) continue;
      sets.link(first, other);
      first = sets.find_set(first);
      --components;
    }
  }
  return components;
}

int count_boundary_loops(const Ends& ends, const JoinedTriangles& joined) {
  std::vector<char> seen(joined.across.size(), 0);
  const auto following = [&](int side) {
    const int start = joined.starts[index(ends.to(side))];
    if (start != kManySides) return start;
    return std::lower_bound(joined.following.begin(), joined.following.end(), std::pair(side, 0))->second;
  };
  int loops = 0;
  for (int first = 0; first < ends.count(); ++first) {
    if (joined.across[index(first)] != kNoSide || seen[index(first)]) continue;
    ++loops;
    for (int side = first; !seen[index(side)]; side = following(side)) seen[index(side)] = 1;
  }
  return loops;
}

/// Vertices at the place of an earlier one. By a table of hashes; where that is crowded, by sorting.
int count_duplicates(const Points& points) {
  constexpr std::size_t kProbes = 64;
  std::size_t size = 1024;
  while (size < 2 * static_cast<std::size_t>(points.rows())) size *= 2;
  std::vector<int> slots(size, -1);
  int duplicates = 0;
  for (int row = 0; row < static_cast<int>(points.rows()); ++row) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double coordinate = points(row, axis) + 0.0;  // -0 and +0 are one place
      std::uint64_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;
    }
    std::size_t probe = 0;
    for (; probe < kProbes; ++probe) {
      int& slot = slots[(hash + probe) & (size - 1)];
      if (slot < 0) slot = row;
      if (points(slot, 0) != points(row, 0) || points(slot, 1) != points(row, 1) || points(slot, 2) != points(row, 2))
        continue;
      duplicates += slot != row;
      break;
    }
    if (probe == kProbes) return static_cast<int>(points.rows() - distinct_points(points).rows());
  }
  return duplicates;
}

}  // namespace

Points distinct_points(const Points& points) {
  Indices rows = rows_by_place(points);
  const auto in_one_place = [&](int a, int b) { return (points.row(a).array() == points.row(b).array()).all(); };
  rows.erase(std::unique(rows.begin(), rows.end(), in_one_place), rows.end());
  return points(rows, Eigen::all);
}

std::vector<Indices> vertex_rings(const Mesh& mesh) {
  const SoundTriangles sound(mesh);
  const Ends ends(sound.triangles());
  std::vector<Indices> rings(static_cast<std::size_t>(mesh.vertices.rows()));
  sound.visit_edges([&](int side) {
    rings[index(ends.from(side))].push_back(ends.to(side));
    rings[index(ends.to(side))].push_back(ends.from(side));
  });
  for (Indices& ring : rings) std::sort(ring.begin(), ring.end());
  return rings;
}

Topology inspect_topology(const Mesh& mesh) {
  Topology topology;
  topology.duplicate_vertices = count_duplicates(mesh.vertices);
  if (mesh.triangles.rows() == 0) return topology;
  std::vector<char> used(static_cast<std::size_t>(mesh.vertices.rows()), 0);
  for (const int vertex : mesh.triangles.reshaped()) used[static_cast<std::size_t>(vertex)] = 1;
  topology.isolated_vertices = static_cast<int>(std::count(used.begin(), used.end(), 0));
  const SoundTriangles sound(mesh);
  topology.degenerate_faces = sound.degenerate();
  topology.misoriented_faces = sound.reversed();
  topology.non_manifold_faces = sound.joined().left_out;
  const Ends ends(sound.triangles());
  topology.components = count_components(ends, sound.joined().across, mesh.vertices.rows());
  topology.boundary_loops = count_boundary_loops(ends, sound.joined());
  double length = 0;
  int edges = 0;
  sound.visit_edges([&](int side) {
    topology.boundary_edges += sound.joined().across[index(side)] == kNoSide;
    const Eigen::Vector3d step = mesh.vertices.row(ends.to(side)) - mesh.vertices.row(ends.from(side));
    length += std::sqrt(step.x() * step.x() + step.y() * step.y() + step.z() * step.z());
    ++edges;
  });
  if (edges > 0) topology.mean_edge_length = length / edges;
  return topology;
}

}  // namespace corral
