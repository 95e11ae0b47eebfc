// SPDX-License-Identifier: MIT
// Around most vertices the triangles are one fan, and can be joined in one way only. Where edges or fans meet that are none
// of one surface, it depends on the order of the triangles; there OpenMesh joins them, and nowhere else.
#include "kernel/surface/mesh/fans.h"

// With OpenMesh 9, g++ 12 at -O3 gives false warnings of uninitialised values.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <mutex>

namespace corral {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using HalfEdge = OpenMesh::SmartHalfedgeHandle;

/// JoinedTriangles::starts, with kManySides where the triangles around a vertex are not one fan wound alike.
Indices fan_starts(const Ends& ends, const Indices& across, Eigen::Index vertices) {
  Indices starts(static_cast<std::size_t>(vertices), kNoSide), corners(starts.size(), 0);
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
  for (std::size_t vertex = 0; vertex < starts.size(); ++vertex) {
    if (starts[vertex] < 0) continue;
    int side = starts[vertex];
    do {
      --corners[vertex];
      side = across[index(ends.before(side))];
    } while (side >= 0 && side != starts[vertex]);
    if (corners[vertex] > 0) starts[vertex] = kManySides;
  }
  return starts;
}

/// The triangles around some vertices, as half-edges.
class Patch {
 public:
  Patch(const Triangles& triangles, const std::vector<char>& within)
      : triangles_(triangles), ends_(triangles), within_(within), handles_(within.size(), kNoSide) {
    // OpenMesh has one error stream for all threads, and neither its creation nor its use is thread-safe. It reports every
    // face that it refuses; here refusals are counted.
    static std::mutex error_stream;
    const std::lock_guard<std::mutex> lock(error_stream);
    const bool was_enabled = omerr().is_enabled();
    omerr().disable();
    Indices faces;
    for (int face = 0; face < ends_.faces(); ++face)
      if (is_within(triangles(face, 0)) || is_within(triangles(face, 1)) || is_within(triangles(face, 2)))
        faces.push_back(face);
    half_.reserve(faces.size(), 2 * faces.size(), faces.size());  // about what it takes
    for (const int face : faces) add(face);
    if (was_enabled) omerr().enable();
  }

  void join(JoinedTriangles& joined) const {
    for (const int face : refused_)
      for (const int side : ends_.sides_of(face)) joined.across[index(side)] = kLeftOut;
    for (const HalfEdge edge : half_.halfedges()) {
      const int from = vertices_[index(edge.from().idx())], to = vertices_[index(edge.to().idx())];
      if (edge.is_boundary() && is_within(from))
        joined.following.emplace_back(side_of(edge.opp()), side_of(edge.prev().opp()));
      if (!edge.is_boundary() && (is_within(from) || is_within(to)))
        joined.across[index(side_of(edge))] = edge.opp().is_boundary() ? kNoSide : side_of(edge.opp());
    }
    std::sort(joined.following.begin(), joined.following.end());
    joined.left_out = static_cast<int>(refused_.size());
  }

 private:
  bool is_within(int vertex) const { return within_[index(vertex)]; }

  void add(int face) {
    std::array<OpenMesh::VertexHandle, 3> corners;
    for (int i = 0; i < 3; ++i) {
      int& handle = handles_[index(triangles_(face, i))];
      if (handle == kNoSide) {
        handle = half_.add_vertex({0, 0, 0}).idx();
        vertices_.push_back(triangles_(face, i));
      }
      corners[index(i)] = OpenMesh::VertexHandle(handle);
    }
    const bool is_accepted = half_.add_face(corners[0], corners[1], corners[2]).is_valid();
    (is_accepted ? faces_ : refused_).push_back(face);
  }

  int side_of(const HalfEdge& edge) const {
    int side = faces_[index(edge.face().idx())];
    while (ends_.from(side) != vertices_[index(edge.from().idx())]) side = ends_.next(side);
    return side;
  }

  const Triangles& triangles_;
  const Ends ends_;
  const std::vector<char>& within_;
  HalfEdgeMesh half_;
  Indices handles_, vertices_;  // of the vertices in half_, and back
  Indices faces_, refused_;     // those in half_, and the others
};

}  // namespace

JoinedTriangles join_triangles(const Triangles& triangles, Indices across, Eigen::Index vertices) {
  JoinedTriangles joined;
  joined.starts = fan_starts(Ends(triangles), across, vertices);
  joined.across = std::move(across);
  if (std::find(joined.starts.begin(), joined.starts.end(), kManySides) == joined.starts.end()) return joined;
  // Only triangles around these vertices are ever refused; the fans of their other corners then have gaps.
  std::vector<char> within(joined.starts.size(), 0);
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    const auto corners = triangles.row(face);
    const auto is_odd = [&](int vertex) { return joined.starts[index(vertex)] == kManySides; };
    if (std::any_of(corners.begin(), corners.end(), is_odd))
      for (const int vertex : corners) within[index(vertex)] = 1;
  }
  Patch(triangles, within).join(joined);
  for (std::size_t vertex = 0; vertex < within.size(); ++vertex)
    if (within[vertex]) joined.starts[vertex] = kManySides;
  return joined;
}

}  // namespace corral
