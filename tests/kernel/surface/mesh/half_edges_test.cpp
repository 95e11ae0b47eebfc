// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/half_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

void expect_report(const HalfEdgeReport& report, int refused_faces, std::optional<int> boundary_loops,
                   double mean_edge_length) {
  EXPECT_EQ(report.refused_faces, refused_faces);
  EXPECT_EQ(report.boundary_loops, boundary_loops);
  EXPECT_NEAR(report.mean_edge_length, mean_edge_length, 1e-14);
}

Mesh mesh_of(const Points& vertices, std::initializer_list<Eigen::RowVector3i> faces) {
  Mesh mesh{vertices, Triangles(static_cast<Eigen::Index>(faces.size()), 3)};
  Eigen::Index row = 0;
  for (const Eigen::RowVector3i& face : faces) mesh.triangles.row(row++) = face;
  return mesh;
}

TEST(HalfEdges, OfAClosedSphere) {
  const Mesh mesh = testing::icosphere(0);
  expect_report(inspect_half_edges(mesh), 0, 0, point_resolution(mesh.vertices));
}

TEST(HalfEdges, AGridHasOneLoopAroundIt) {
  // 5 * 4 edges along x, 6 * 3 along y and 5 * 3 diagonals.
  expect_report(inspect_half_edges(testing::grid(6, 4, 0.5)), 0, 1, 0.5 * (20 + 18 + 15 * std::sqrt(2.0)) / 53);
}

TEST(HalfEdges, AHoleAddsALoop) {
  Mesh mesh = testing::grid(6, 6);
  Triangles rest(mesh.triangles.rows() - 2, 3);  // without the two triangles of a cell inside
  rest << mesh.triangles.topRows(24), mesh.triangles.bottomRows(mesh.triangles.rows() - 26);
  mesh.triangles = rest;
  const HalfEdgeReport report = inspect_half_edges(mesh);
  EXPECT_EQ(report.boundary_loops, 2);
  EXPECT_EQ(report.refused_faces, 0);
}

TEST(HalfEdges, OneTriangle) {
  expect_report(inspect_half_edges(mesh_of(points_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}), {{0, 1, 2}})), 0, 1, 4);
}

TEST(HalfEdges, AThirdTriangleOnAnEdgeIsRefused) {
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}});
  const HalfEdgeReport report = inspect_half_edges(mesh_of(vertices, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  expect_report(report, 1, std::nullopt, (3 + 2 * std::sqrt(2.0)) / 5);
}

TEST(HalfEdges, DegenerateTrianglesAreNoneAndWindingIsMended) {
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
  const HalfEdgeReport report = inspect_half_edges(mesh_of(vertices, {{0, 1, 2}, {0, 1, 1}, {0, 2, 3}, {0, 1, 3}}));
  expect_report(report, 0, 1, (3 + 2 * std::sqrt(2.0)) / 5);
}

TEST(HalfEdges, WithoutTrianglesThereIsNothing) {
  expect_report(inspect_half_edges({points_of({{0, 0, 0}, {1, 0, 0}}), Triangles(0, 3)}), 0, 0, 0);
  EXPECT_EQ(half_edge_rings(Triangles(0, 3), 2), std::vector<Indices>(2));
}

TEST(HalfEdges, RingsLeaveRefusedTrianglesOut) {
  Triangles triangles(3, 3);
  triangles << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  EXPECT_EQ(half_edge_rings(triangles, 6), (std::vector<Indices>{{1, 2, 3}, {0, 2, 3}, {0, 1}, {0, 1}, {}, {}}));
}

}  // namespace
}  // namespace corral
