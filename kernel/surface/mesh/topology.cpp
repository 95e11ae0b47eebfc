// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/topology.h"

// With OpenMesh 9, g++ 12 at -O3 gives false warnings of uninitialised values.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/sides.h"

namespace corral {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

bool is_degenerate(const Mesh& mesh, Eigen::Index face) {
  const int a = mesh.triangles(face, 0), b = mesh.triangles(face, 1), c = mesh.triangles(face, 2);
  if (a == b || b == c || c == a) return true;
  return !(triangle_area(mesh.vertices.row(a), mesh.vertices.row(b), mesh.vertices.row(c)) > 0);
}

/// The triangles of a mesh without degenerate ones, wound alike. They are copied only if any must change.
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
    across_ = sides_across(triangles(), mesh.vertices.rows());
    reverse(wound_against_majority(triangles(), across_), mesh.vertices.rows());
  }

  const Triangles& triangles() const { return changed_ ? *changed_ : given_; }
  const Indices& across() const { return across_; }
  int degenerate() const { return degenerate_; }
  int reversed() const { return reversed_; }

 private:
  void reverse(const Indices& faces, Eigen::Index vertices) {
    reversed_ = static_cast<int>(faces.size());
    if (reversed_ == 0) return;
    if (!changed_) changed_ = given_;
    for (const int face : faces) std::swap((*changed_)(face, 1), (*changed_)(face, 2));
    across_ = sides_across(*changed_, vertices);
  }

  const Triangles& given_;
  std::optional<Triangles> changed_;
  Indices across_;
  int degenerate_ = 0, reversed_ = 0;
};

/// The half-edges of sound triangles that are wound alike; counts the triangles that they cannot hold.
HalfEdgeMesh half_edges(const Points& vertices, const Triangles& triangles, Topology& topology) {
  // OpenMesh has one error stream for all threads, and neither its creation nor its use is thread-safe.
  static std::mutex error_stream;
  const std::lock_guard<std::mutex> lock(error_stream);
  HalfEdgeMesh half;
  for (Eigen::Index row = 0; row < vertices.rows(); ++row)
    half.add_vertex({vertices(row, 0), vertices(row, 1), vertices(row, 2)});
  // OpenMesh reports every face that it refuses on a stream of its own; here refusals are counted.
  const bool was_enabled = omerr().is_enabled();
  omerr().disable();
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    const auto corner = [&](int i) { return OpenMesh::VertexHandle(triangles(face, i)); };
    topology.non_manifold_faces += !half.add_face(corner(0), corner(1), corner(2)).is_valid();
  }
  if (was_enabled) omerr().enable();
  return half;
}

int count_components(const HalfEdgeMesh& half) {
  std::vector<int> rank(half.n_vertices()), parent(half.n_vertices());
  boost::disjoint_sets<int*, int*> sets(rank.data(), parent.data());
  for (int vertex = 0; vertex < static_cast<int>(half.n_vertices()); ++vertex) sets.make_set(vertex);
  for (const auto edge : half.edges()) sets.union_set(edge.v0().idx(), edge.v1().idx());
  std::vector<int> roots;
  for (const auto edge : half.edges()) roots.push_back(sets.find_set(edge.v0().idx()));
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

int count_boundary_loops(const HalfEdgeMesh& half) {
  std::vector<char> seen(half.n_halfedges(), 0);
  int loops = 0;
  for (const auto start : half.halfedges()) {
    if (!start.is_boundary() || seen[static_cast<std::size_t>(start.idx())]) continue;
    ++loops;
    for (auto edge = start; !seen[static_cast<std::size_t>(edge.idx())]; edge = edge.next())
      seen[static_cast<std::size_t>(edge.idx())] = 1;
  }
  return loops;
}

/// Where edges or fans meet that are none of one surface, the counts depend on how half-edges join them.
void walk_half_edges(const HalfEdgeMesh& half, Topology& topology) {
  topology.components = count_components(half);
  topology.boundary_loops = count_boundary_loops(half);
  double length = 0;
  for (const auto edge : half.edges()) {
    topology.boundary_edges += edge.is_boundary();
    length += half.calc_edge_length(edge);
  }
  if (half.n_edges() > 0) topology.mean_edge_length = length / static_cast<double>(half.n_edges());
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
  Topology unused;
  const SoundTriangles sound(mesh);
  const HalfEdgeMesh half = half_edges(mesh.vertices, sound.triangles(), unused);
  std::vector<Indices> rings(static_cast<std::size_t>(mesh.vertices.rows()));
  // By edges, not by turning around each vertex: where two fans touch in a vertex, the turn would see one of them.
  for (const auto edge : half.edges()) {
    const int a = edge.v0().idx(), b = edge.v1().idx();
    rings[static_cast<std::size_t>(a)].push_back(b);
    rings[static_cast<std::size_t>(b)].push_back(a);
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
  topology.degenerate_faces = sound.degenerate();
  topology.misoriented_faces = sound.reversed();
  const SoundEdges edges = inspect_edges(mesh.vertices, sound.triangles(), sound.across());
  if (!edges.is_sound) {
    walk_half_edges(half_edges(mesh.vertices, sound.triangles(), topology), topology);
    return topology;
  }
  topology.components = edges.components;
  topology.boundary_edges = edges.boundary_edges;
  topology.boundary_loops = edges.boundary_loops;
  topology.mean_edge_length = edges.mean_edge_length;
  return topology;
}

}  // namespace corral
