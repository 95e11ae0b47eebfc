// SPDX-License-Identifier: MIT
#pragma once

// Views for tests, and their triangles in a form to compare.

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "kernel/random.h"
#include "kernel/surface/scan/view_triangulation.h"

namespace corral::testing {

inline ViewOptions seen_from(const Eigen::Vector3d& sensor) {
  ViewOptions options;
  options.sensor = sensor;
  return options;
}

inline ViewOptions seen_along(const Eigen::Vector3d& direction) {
  ViewOptions options;
  options.direction = direction;
  return options;
}

/// Nothing that the sensor sees is dropped.
inline ViewOptions unlimited(ViewOptions options) {
  options.longest_edge_pr = 1e9;
  options.grazing_deg = 90;
  return options;
}

/// Points of a rough surface about z = 0, none in line with others, in no order.
inline Points rough_view(int count, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(count, 3);
  for (int row = 0; row < count; ++row)
    points.row(row) << random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-1, 1);
  return points;
}

using Corners = std::array<int, 3>;

/// The triangles with other numbers for their vertices, in the order that triangulate_view promises.
inline std::vector<Corners> renumbered(const Triangles& triangles, const Indices& number) {
  std::vector<Corners> rows;
  for (Eigen::Index face = 0; face < triangles.rows(); ++face) {
    Corners row;
    for (std::size_t i = 0; i < 3; ++i)
      row[i] = number[static_cast<std::size_t>(triangles(face, static_cast<Eigen::Index>(i)))];
    std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
    rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

inline Indices counted(Eigen::Index count) {
  Indices rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace corral::testing
