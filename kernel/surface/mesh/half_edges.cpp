// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/half_edges.h"

// With OpenMesh 9, g++ 12 at -O3 gives false warnings of uninitialised values.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <mutex>

#include "kernel/surface/mesh/sides.h"
#include "kernel/surface/mesh/sound_triangles.h"

namespace corral {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// Adds the triangles one by one; returns how many are refused.
int add_faces(const Triangles& triangles, HalfEdgeMesh& half) {
  // OpenMesh has one error stream for all threads, and neither its creation nor its use is thread-safe. It reports every
  // face that it refuses; here refusals are counted.
  static std::mutex error_stream;
  const std::lock_guard<std::mutex> lock(error_stream);
  const bool was_enabled = omerr().is_enabled();
  omerr().disable();
  int refused = 0;
  for (const auto& face : triangles.rowwise()) {
    const auto corner = [&](int i) { return OpenMesh::VertexHandle(face(i)); };
    refused += !half.add_face(corner(0), corner(1), corner(2)).is_valid();
  }
  if (was_enabled) omerr().enable();
  return refused;
}

int count_boundary_loops(const HalfEdgeMesh& half) {
  std::vector<char> seen(half.n_halfedges(), 0);
  int loops = 0;
  for (const OpenMesh::SmartHalfedgeHandle start : half.halfedges()) {
    if (!start.is_boundary() || seen[index(start.idx())]) continue;
    ++loops;
    for (auto edge = start; !seen[index(edge.idx())]; edge = edge.next()) seen[index(edge.idx())] = 1;
  }
  return loops;
}

}  // namespace

HalfEdgeReport inspect_half_edges(const Mesh& mesh) {
  HalfEdgeReport report;
  HalfEdgeMesh half;
  for (const auto& place : mesh.vertices.rowwise()) half.add_vertex({place.x(), place.y(), place.z()});
  report.refused_faces = add_faces(SoundTriangles(mesh)(), half);
  if (report.refused_faces == 0) report.boundary_loops = count_boundary_loops(half);
  double length = 0;
  for (const auto edge : half.edges()) length += half.calc_edge_length(edge);
  if (half.n_edges() > 0) report.mean_edge_length = length / static_cast<double>(half.n_edges());
  return report;
}

std::vector<Indices> half_edge_rings(const Triangles& triangles, Eigen::Index vertices) {
  HalfEdgeMesh half;
  for (Eigen::Index vertex = 0; vertex < vertices; ++vertex) half.add_vertex({0, 0, 0});
  add_faces(triangles, half);
  std::vector<Indices> rings(index(static_cast<int>(vertices)));
  for (const auto edge : half.edges()) {
    rings[index(edge.v0().idx())].push_back(edge.v1().idx());
    rings[index(edge.v1().idx())].push_back(edge.v0().idx());
  }
  for (Indices& ring : rings) std::sort(ring.begin(), ring.end());
  return rings;
}

}  // namespace corral
