// SPDX-License-Identifier: MIT
#include "tests/support/point_sets.h"

#include <cmath>

#include "kernel/random.h"
#include "tests/support/tables.h"

namespace corral::testing {

Points uniform_points(int count, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(count, 3);
  for (int row = 0; row < count; ++row)
    for (int axis = 0; axis < 3; ++axis) points(row, axis) = random.uniform(-1, 1);
  return points;
}

Points clustered_points(int count, std::uint64_t seed) {
  RandomStream random(seed);
  Points points(count, 3);
  for (int row = 0; row < count; ++row)
    points.row(row) =
        (row % 6) * Eigen::RowVector3d::Ones() + std::pow(10.0, -(row % 5)) * random.direction().transpose();
  return points;
}

Points lattice(int side) {
  Points points(side * side * side, 3);
  for (int row = 0; row < points.rows(); ++row) points.row(row) << row % side, row / side % side, row / (side * side);
  return points;
}

Points stacked(const std::vector<Points>& parts) {
  Eigen::Index count = 0;
  for (const Points& part : parts) count += part.rows();
  Points all(count, 3);
  Eigen::Index next = 0;
  for (const Points& part : parts) {
    all.middleRows(next, part.rows()) = part;
    next += part.rows();
  }
  return all;
}

std::vector<PointSet> hard_point_sets() {
  const Points some = uniform_points(500, 1), tenths = 0.1 * lattice(7);
  Points flat = uniform_points(400, 2), straight = uniform_points(200, 3), duplicates = uniform_points(300, 4);
  flat.col(2).setConstant(0.25);
  straight.rightCols(2).setConstant(-3);
  for (int row = 100; row < 300; ++row) duplicates.row(row) = duplicates.row(row % 100);
  const auto far_away = [](double x) { return points_of({{x, -x, 0}}); };
  return {{"uniform", some, 0.15},
          {"clustered", clustered_points(500, 5), 0.05},
          {"lattice", lattice(7), 1},
          {"tenths", tenths, 0.1},
          {"tenths with an offset", tenths.array() + 0.7, 0.1},
          {"flat", flat, 0.1},
          {"straight", straight, 0.01},
          {"duplicates", duplicates, 0.2},
          {"all in one place", Points::Constant(60, 3, -2.5), 1},
          {"one outlier", stacked({some, far_away(1e6)}), 0.15},
          {"outlier of a lattice", stacked({tenths, far_away(-1e6)}), 0.1},
          {"farther outlier of a lattice", stacked({tenths, far_away(-1e13)}), 0.1},
          {"outliers on two sides", stacked({lattice(6), far_away(-1e7), far_away(1e7)}), 1},
          {"outlier at the end of what a key holds", stacked({lattice(6), far_away(1e15)}), 1},
          {"outlier beyond", stacked({lattice(6), far_away(1e18), far_away(-1e18)}), 1},
          {"two clusters", stacked({some, 1e5 + some.array()}), 0.15},
          {"far from the origin", some.array() + 1e7, 0.15},
          {"none", Points(0, 3), 1},
          {"one", points_of({{1, 2, 3}}), 1},
          {"two", points_of({{1, 2, 3}, {1, 2, 4}}), 1},
          {"three", points_of({{1, 2, 3}, {1, 2, 4}, {1, 3, 4}}), 1}};
}

}  // namespace corral::testing
