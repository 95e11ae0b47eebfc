// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/grid_triangulation.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

const Points kSquare = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});

Triangles faces(std::initializer_list<Eigen::RowVector3i> each) {
  Triangles triangles(static_cast<Eigen::Index>(each.size()), 3);
  Eigen::Index row = 0;
  for (const Eigen::RowVector3i& face : each) triangles.row(row++) = face;
  return triangles;
}

TEST(GridTriangulation, FourNeighboursAreTwoTrianglesOnTheShorterDiagonal) {
  EXPECT_EQ(triangulate_grid(kSquare, {0, 1, 2, 3}, 2), faces({{0, 1, 3}, {0, 3, 2}})) << "both are as long";
  Points shifted = kSquare;
  shifted(1, 0) = shifted(3, 0) = 1.5;
  shifted(0, 0) = 0.5;
  EXPECT_EQ(triangulate_grid(shifted, {0, 1, 2, 3}, 2), faces({{0, 1, 3}, {0, 3, 2}}));
  shifted(0, 0) = -0.5;
  EXPECT_EQ(triangulate_grid(shifted, {0, 1, 2, 3}, 2), faces({{0, 1, 2}, {1, 3, 2}}));
}

TEST(GridTriangulation, ThreeNeighboursAreOneTriangle) {
  EXPECT_EQ(triangulate_grid(kSquare, {-1, 1, 2, 3}, 2), faces({{1, 3, 2}}));
  EXPECT_EQ(triangulate_grid(kSquare, {0, -1, 2, 3}, 2), faces({{0, 3, 2}}));
  EXPECT_EQ(triangulate_grid(kSquare, {0, 1, 2, -1}, 2), faces({{0, 1, 2}}));
  EXPECT_EQ(triangulate_grid(kSquare, {0, 1, -1, 3}, 2), faces({{0, 1, 3}}));
  for (const Indices& cells : {Indices{0, 1, -1, -1}, Indices{-1, -1, -1, -1}, Indices{}})
    EXPECT_EQ(triangulate_grid(kSquare, cells, 2).rows(), 0);
  EXPECT_EQ(triangulate_grid(kSquare, {0, 1, 2, 3}, 4).rows(), 0) << "one row";
}

TEST(GridTriangulation, FacesSpanNoJumpInDepth) {
  Mesh sheet = testing::grid(10, 10);
  Indices cells(100);
  for (int i = 0; i < 100; ++i) cells[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(triangulate_grid(sheet.vertices, cells, 10).rows(), 162);
  for (int row = 0; row < 10; ++row)
    for (int column = 5; column < 10; ++column) sheet.vertices(10 * row + column, 2) = -kLongestGridEdge;
  EXPECT_EQ(triangulate_grid(sheet.vertices, cells, 10).rows(), 162 - 18);
  sheet.vertices(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(triangulate_grid(sheet.vertices, cells, 10).rows(), 162 - 18 - 1);
}

}  // namespace
}  // namespace corral
