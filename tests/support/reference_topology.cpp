// SPDX-License-Identifier: MIT
#include "tests/support/reference_topology.h"

// With OpenMesh 9, g++ 12 at -O3 gives false warnings of uninitialised values.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <set>
#include <tuple>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/sides.h"

namespace corral::testing {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// The triangles with area, wound alike.
Triangles sound_triangles(const Mesh& mesh, Topology& topology) {
  Indices sound;
  for (int face = 0; face < static_cast<int>(mesh.triangles.rows()); ++face) {
    const auto corner = [&](int i) { return mesh.triangles(face, i); };
    const bool is_sound =
        std::set<int>{corner(0), corner(1), corner(2)}.size() == 3 &&
        triangle_area(mesh.vertices.row(corner(0)), mesh.vertices.row(corner(1)), mesh.vertices.row(corner(2))) > 0;
    if (is_sound) sound.push_back(face);
  }
  topology.degenerate_faces = static_cast<int>(mesh.triangles.rows()) - static_cast<int>(sound.size());
  Triangles triangles = mesh.triangles(sound, Eigen::all);
  const Indices against = wound_against_majority(triangles, sides_across(triangles, mesh.vertices.rows()));
  for (const int face : against) std::swap(triangles(face, 1), triangles(face, 2));
  topology.misoriented_faces = static_cast<int>(against.size());
  return triangles;
}

HalfEdgeMesh half_edges(const Mesh& mesh, Topology& topology) {
  const Triangles triangles = sound_triangles(mesh, topology);
  HalfEdgeMesh half;
  for (const auto& place : mesh.vertices.rowwise()) half.add_vertex({place.x(), place.y(), place.z()});
  omerr().disable();
  for (const auto& face : triangles.rowwise())
    topology.non_manifold_faces += !half.add_face(OpenMesh::VertexHandle(face(0)), OpenMesh::VertexHandle(face(1)),
                                                  OpenMesh::VertexHandle(face(2)))
                                        .is_valid();
  omerr().enable();
  return half;
}

/// By flooding over the edges.
int count_components(const HalfEdgeMesh& half) {
  std::vector<char> seen(half.n_vertices(), 0);
  int components = 0;
  for (const auto seed : half.vertices()) {
    if (seen[static_cast<std::size_t>(seed.idx())]++ || half.is_isolated(seed)) continue;
    ++components;
    for (std::vector<OpenMesh::SmartVertexHandle> open{seed}; !open.empty();) {
      const auto vertex = open.back();
      open.pop_back();
      for (const auto other : vertex.vertices())
        if (!seen[static_cast<std::size_t>(other.idx())]++) open.push_back(other);
    }
  }
  return components;
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

Topology reference_topology(const Mesh& mesh) {
  Topology topology;
  std::set<std::tuple<double, double, double>> places;
  for (const auto& place : mesh.vertices.rowwise()) places.emplace(place.x(), place.y(), place.z());
  topology.duplicate_vertices = static_cast<int>(mesh.vertices.rows()) - static_cast<int>(places.size());
  if (mesh.triangles.rows() == 0) return topology;
  std::set<int> used;
  for (const int vertex : mesh.triangles.reshaped()) used.insert(vertex);
  topology.isolated_vertices = static_cast<int>(mesh.vertices.rows()) - static_cast<int>(used.size());
  const HalfEdgeMesh half = half_edges(mesh, topology);
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

std::vector<Indices> reference_rings(const Mesh& mesh) {
  Topology unused;
  const HalfEdgeMesh half = half_edges(mesh, unused);
  std::vector<Indices> rings(half.n_vertices());
  for (const auto edge : half.edges()) {
    rings[static_cast<std::size_t>(edge.v0().idx())].push_back(edge.v1().idx());
    rings[static_cast<std::size_t>(edge.v1().idx())].push_back(edge.v0().idx());
  }
  for (Indices& ring : rings) std::sort(ring.begin(), ring.end());
  return rings;
}

}  // namespace corral::testing
