// SPDX-License-Identifier: MIT
#include "tests/support/reference/topology.h"

// With OpenMesh 9, g++ 12 at -O3 gives false warnings of uninitialised values.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <map>
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
  const Indices against = wound_against_majority(triangles, join_sides(triangles, mesh.vertices.rows()).across);
  for (const int face : against) std::swap(triangles(face, 1), triangles(face, 2));
  topology.misoriented_faces = static_cast<int>(against.size());
  return triangles;
}

using Edges =
    std::map<std::pair<int, int>, std::vector<std::pair<int, bool>>>;  // triangles, and whether they run upwards

Edges edges_of(const Triangles& triangles) {
  Edges edges;
  for (int face = 0; face < static_cast<int>(triangles.rows()); ++face)
    for (int i = 0; i < 3; ++i) {
      const int from = triangles(face, i), to = triangles(face, (i + 1) % 3);
      edges[{std::min(from, to), std::max(from, to)}].push_back({face, from < to});
    }
  return edges;
}

/// Whether the triangles around a vertex are one fan: joined across edges of two that run opposite ways along them.
bool is_one_fan(const Triangles& triangles, const Edges& edges, int vertex) {
  std::set<int> around;
  for (int face = 0; face < static_cast<int>(triangles.rows()); ++face)
    if ((triangles.row(face).array() == vertex).any()) around.insert(face);
  if (around.empty()) return true;
  std::vector<int> open{*around.begin()};
  for (around.erase(around.begin()); !open.empty();) {
    const int face = open.back();
    open.pop_back();
    for (const auto& [edge, sides] : edges) {
      if (edge.first != vertex && edge.second != vertex) continue;
      if (sides.size() > 2 || (sides.size() == 2 && sides[0].second == sides[1].second)) return false;
      for (std::size_t i = 0; i < 2 && sides.size() == 2; ++i)
        if (sides[i].first == face && around.erase(sides[1 - i].first) > 0) open.push_back(sides[1 - i].first);
    }
  }
  return around.empty();
}

/// Triangles that share a vertex are of one component.
int count_components(const Triangles& triangles) {
  std::vector<std::set<int>> parts;
  for (const auto& face : triangles.rowwise()) {
    std::set<int> part(face.begin(), face.end());
    std::vector<std::set<int>> others;
    for (std::set<int>& other : parts) {
      const bool is_met = std::any_of(face.begin(), face.end(), [&](int vertex) { return other.count(vertex) > 0; });
      is_met ? part.merge(other) : others.push_back(other);
    }
    others.push_back(part);
    parts = others;
  }
  return static_cast<int>(parts.size());
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
  const Triangles triangles = sound_triangles(mesh, topology);
  const Edges edges = edges_of(triangles);
  for (const auto& [edge, sides] : edges) {
    topology.boundary_edges += sides.size() == 1;
    topology.non_manifold_edges += sides.size() > 2;
  }
  for (int vertex = 0; vertex < static_cast<int>(mesh.vertices.rows()); ++vertex)
    topology.non_manifold_vertices += !is_one_fan(triangles, edges, vertex);
  topology.components = count_components(triangles);
  return topology;
}

std::vector<Indices> reference_rings(const Mesh& mesh) {
  Topology unused;
  const Triangles triangles = sound_triangles(mesh, unused);
  HalfEdgeMesh half;
  for (const auto& place : mesh.vertices.rowwise()) half.add_vertex({place.x(), place.y(), place.z()});
  omerr().disable();
  for (const auto& face : triangles.rowwise())
    half.add_face(OpenMesh::VertexHandle(face(0)), OpenMesh::VertexHandle(face(1)), OpenMesh::VertexHandle(face(2)));
  omerr().enable();
  std::vector<Indices> rings(half.n_vertices());
  for (const auto edge : half.edges()) {
    rings[static_cast<std::size_t>(edge.v0().idx())].push_back(edge.v1().idx());
    rings[static_cast<std::size_t>(edge.v1().idx())].push_back(edge.v0().idx());
  }
  for (Indices& ring : rings) std::sort(ring.begin(), ring.end());
  return rings;
}

}  // namespace corral::testing
