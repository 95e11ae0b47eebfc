// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/topology.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernel/surface/mesh/half_edges.h"
#include "kernel/surface/mesh/sound_triangles.h"

namespace corral {
namespace {

/// Whether the triangles around each vertex are not one fan wound alike.
std::vector<char> odd_vertices(const Ends& ends, const Indices& across, Eigen::Index vertices) {
  Indices starts(static_cast<std::size_t>(vertices), kNoSide), corners(starts.size(), 0);  // where a fan begins
  for (int side = 0; side < ends.count(); ++side) {
    const int other = across[index(side)];
    int& start = starts[index(ends.from(side))];
    ++corners[index(ends.from(side))];
    if (other == kManySides || (other >= 0 && ends.from(other) == ends.from(side)))
      start = starts[index(ends.to(side))] = kManySides;
    if (start == kManySides) continue;
    const bool is_boundary = other == kNoSide;
    if (is_boundary && start != kNoSide && across[index(start)] == kNoSide)
      start = kManySides;
    else if (is_boundary || start == kNoSide)
      start = side;
  }
  std::vector<char> is_odd(starts.size(), 0);
  for (std::size_t vertex = 0; vertex < starts.size(); ++vertex) {
    is_odd[vertex] = starts[vertex] == kManySides;
    if (starts[vertex] < 0) continue;
    int side = starts[vertex];
    do {
      --corners[vertex];
      side = across[index(ends.before(side))];
    } while (side >= 0 && side != starts[vertex]);
    is_odd[vertex] = corners[vertex] > 0;
  }
  return is_odd;
}

/// Parts that share no vertex.
int count_components(const Ends& ends, Eigen::Index vertices) {
  Indices rank(static_cast<std::size_t>(vertices)), parent(rank.size(), kNoSide);
  boost::disjoint_sets<int*, int*> sets(rank.data(), parent.data());
  int components = 0;
  for (int face = 0; face < ends.faces(); ++face) {
    int first = kNoSide;
    for (const int side : ends.sides_of(face)) {
      const int vertex = ends.from(side);
      if (parent[index(vertex)] == kNoSide) sets.make_set(vertex), ++components;
      if (parent[index(vertex)] == first) continue;
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
  const Indices& across = sound.joined().across;
  const Ends ends(sound());
  const std::vector<char> is_odd = odd_vertices(ends, across, mesh.vertices.rows());
  if (std::find(is_odd.begin(), is_odd.end(), 1) != is_odd.end()) return half_edge_rings(sound(), mesh.vertices.rows());
  std::vector<Indices> rings(is_odd.size());
  for (int side = 0; side < ends.count(); ++side) {
    if (across[index(side)] > side) continue;  // an edge is named by its later side, or its only one
    rings[index(ends.from(side))].push_back(ends.to(side));
    rings[index(ends.to(side))].push_back(ends.from(side));
  }
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
  const Indices& across = sound.joined().across;
  const Ends ends(sound());
  topology.degenerate_faces = sound.degenerate();
  topology.misoriented_faces = sound.reversed();
  topology.non_manifold_edges = sound.joined().many_edges;
  const std::vector<char> is_odd = odd_vertices(ends, across, mesh.vertices.rows());
  topology.non_manifold_vertices = static_cast<int>(std::count(is_odd.begin(), is_odd.end(), 1));
  topology.components = count_components(ends, mesh.vertices.rows());
  topology.boundary_edges = static_cast<int>(std::count(across.begin(), across.end(), kNoSide));
  return topology;
}

}  // namespace corral
