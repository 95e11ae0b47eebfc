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
#include <mutex>
#include <tuple>
#include <vector>

#include "kernel/rigid_transform.h"

namespace corral {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

bool is_degenerate(const Mesh& mesh, Eigen::Index face) {
  const int a = mesh.triangles(face, 0), b = mesh.triangles(face, 1), c = mesh.triangles(face, 2);
  if (a == b || b == c || c == a) return true;
  return !(triangle_area(mesh.vertices.row(a), mesh.vertices.row(b), mesh.vertices.row(c)) > 0);
}

Triangles sound_triangles(const Mesh& mesh) {
  std::vector<Eigen::Index> sound;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face)
    if (!is_degenerate(mesh, face)) sound.push_back(face);
  return mesh.triangles(sound, Eigen::all);
}

/// One side of a triangle: its vertices in ascending order, and whether the triangle runs along it that way.
struct Side {
  int low, high;
  int face;
  bool upwards;
};

/// All sides, those of one edge next to each other.
std::vector<Side> sorted_sides(const Triangles& triangles) {
  std::vector<Side> sides;
  for (int face = 0; face < static_cast<int>(triangles.rows()); ++face)
    for (int corner = 0; corner < 3; ++corner) {
      const int from = triangles(face, corner), to = triangles(face, (corner + 1) % 3);
      sides.push_back({std::min(from, to), std::max(from, to), face, from < to});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  return sides;
}

/// A triangle on the other side of an edge that no third one shares; `against` if both run along it the same way.
struct Across {
  int face;
  bool against;
};

std::vector<std::vector<Across>> neighbors_across(const Triangles& triangles) {
  std::vector<std::vector<Across>> across(static_cast<std::size_t>(triangles.rows()));
  const std::vector<Side> sides = sorted_sides(triangles);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(
        first, sides.end(), [&](const Side& side) { return side.low != first->low || side.high != first->high; });
    if (last - first == 2) {
      const Side &a = first[0], &b = first[1];
      across[static_cast<std::size_t>(a.face)].push_back({b.face, a.upwards == b.upwards});
      across[static_cast<std::size_t>(b.face)].push_back({a.face, a.upwards == b.upwards});
    }
    first = last;
  }
  return across;
}

/// Reverses the triangles of each part that are wound against its majority; returns their number.
int orient(Triangles& triangles) {
  const auto across = neighbors_across(triangles);
  enum Turn : char { Unknown, Kept, Turned };
  std::vector<Turn> turns(static_cast<std::size_t>(triangles.rows()), Unknown);
  int count = 0;
  for (int seed = 0; seed < static_cast<int>(triangles.rows()); ++seed) {
    if (turns[static_cast<std::size_t>(seed)] != Unknown) continue;
    turns[static_cast<std::size_t>(seed)] = Kept;
    Indices part{seed}, turned;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const Turn here = turns[static_cast<std::size_t>(part[next])];
      if (here == Turned) turned.push_back(part[next]);
      for (const Across& other : across[static_cast<std::size_t>(part[next])]) {
        Turn& there = turns[static_cast<std::size_t>(other.face)];
        if (there != Unknown) continue;
        there = (here == Turned) == other.against ? Kept : Turned;
        part.push_back(other.face);
      }
    }
    const bool most_turned = 2 * turned.size() > part.size();
    for (const int face : most_turned ? part : turned)
      if (!most_turned || turns[static_cast<std::size_t>(face)] == Kept) {
        std::swap(triangles(face, 1), triangles(face, 2));
        ++count;
      }
  }
  return count;
}

/// Builds the half-edges and counts the triangles that they cannot hold.
HalfEdgeMesh half_edges(const Mesh& mesh, Topology& topology) {
  // OpenMesh has one error stream for all threads, and neither its creation nor its use is thread-safe.
  static std::mutex error_stream;
  const std::lock_guard<std::mutex> lock(error_stream);
  HalfEdgeMesh half;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    half.add_vertex({mesh.vertices(row, 0), mesh.vertices(row, 1), mesh.vertices(row, 2)});
  // OpenMesh reports every face that it refuses on a stream of its own; here refusals are counted.
  const bool was_enabled = omerr().is_enabled();
  omerr().disable();
  Triangles triangles = sound_triangles(mesh);
  topology.degenerate_faces = static_cast<int>(mesh.triangles.rows() - triangles.rows());
  topology.misoriented_faces = orient(triangles);
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

}  // namespace

Points distinct_points(const Points& points) {
  Indices rows = rows_by_place(points);
  const auto in_one_place = [&](int a, int b) { return (points.row(a).array() == points.row(b).array()).all(); };
  rows.erase(std::unique(rows.begin(), rows.end(), in_one_place), rows.end());
  return points(rows, Eigen::all);
}

std::vector<Indices> vertex_rings(const Mesh& mesh) {
  Topology unused;
  const HalfEdgeMesh half = half_edges(mesh, unused);
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
  topology.duplicate_vertices = static_cast<int>(mesh.vertices.rows() - distinct_points(mesh.vertices).rows());
  if (mesh.triangles.rows() == 0) return topology;
  const HalfEdgeMesh half = half_edges(mesh, topology);
  std::vector<char> used(static_cast<std::size_t>(mesh.vertices.rows()), 0);
  for (const int vertex : mesh.triangles.reshaped()) used[static_cast<std::size_t>(vertex)] = 1;
  topology.isolated_vertices = static_cast<int>(std::count(used.begin(), used.end(), 0));
  topology.components = count_components(half);
  topology.boundary_loops = count_boundary_loops(half);
  double length = 0;
  for (const auto edge : half.edges()) {
    topology.boundary_edges += edge.is_boundary();
    length += half.calc_edge_length(edge);
  }
  if (half.n_edges() > 0) topology.mean_edge_length = length / static_cast<double>(half.n_edges());
  return topology;
}

}  // namespace corral
