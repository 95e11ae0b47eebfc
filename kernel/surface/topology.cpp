// SPDX-License-Identifier: MIT
#include "kernel/surface/topology.h"

// OpenMesh 9 makes g++ 12 see uninitialised values at -O3 that are not there.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <numeric>
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

/// Builds the half-edges and counts what they cannot take.
HalfEdgeMesh half_edges(const Mesh& mesh, Topology& topology) {
  HalfEdgeMesh half;
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row)
    half.add_vertex({mesh.vertices(row, 0), mesh.vertices(row, 1), mesh.vertices(row, 2)});
  // OpenMesh reports every face that it refuses on a stream of its own; here refusals are counted.
  const bool was_enabled = omerr().is_enabled();
  omerr().disable();
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    if (is_degenerate(mesh, face)) {
      ++topology.degenerate_faces;
      continue;
    }
    const auto corner = [&](int i) { return OpenMesh::VertexHandle(mesh.triangles(face, i)); };
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
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto key = [&](Eigen::Index row) { return std::make_tuple(points(row, 0), points(row, 1), points(row, 2)); };
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return key(a) < key(b); });
  order.erase(std::unique(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return key(a) == key(b); }),
              order.end());
  return points(order, Eigen::all);
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
