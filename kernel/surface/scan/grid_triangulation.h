// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// The longest edge of a triangle, in median distances between neighbours in the grid: a longer one spans a jump in depth.
constexpr double kLongestGridEdge = 6;

/// Gives faces to a range scan whose points are in a grid, as its sensor measured them: `cells` names the vertex of each cell,
/// row by row, -1 where there is none. Four neighbours are two triangles that meet in the shorter diagonal (in that from the
/// first to the last cell if both are as long), three are one. A triangle with an edge that is longer than
/// kLongestGridEdge times the median distance between neighbours in a row or column is left out, as is one with a vertex
/// that has no place (nan).
///
/// Counter-clockwise where columns go right and rows up. The Stanford scans are so seen from their sensor: in all 25 views of
/// the bunny and the standing dragon 99 to 100 % of the cells face +z, where it was.
///
/// cells.size() is a multiple of `columns`, and every vertex in it exists.
Triangles triangulate_grid(const Points& vertices, const Indices& cells, std::int64_t columns);

}  // namespace corral
