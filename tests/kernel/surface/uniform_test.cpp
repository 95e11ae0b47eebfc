// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "kernel/error.h"
#include "kernel/surface/search/resolution.h"
#include "kernel/surface/uniform.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/renumbering.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::points_of;

using Cube = std::array<double, 3>;

/// Every vertex into its cube, one after the other; then the one nearest to the middle of each, the first of equals.
Indices reference_uniform(const Points& vertices, double spacing) {
  std::map<Cube, std::pair<double, int>> nearest;
  if (vertices.rows() == 0) return {};
  const Eigen::RowVector3d corner = vertices.colwise().minCoeff();
  for (int row = 0; row < vertices.rows(); ++row) {
    Cube cube;
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = (vertices(row, axis) - corner(axis)) / spacing;
      cube[static_cast<std::size_t>(axis)] = std::floor(place);
      squared += std::pow(place - std::floor(place) - 0.5, 2);
    }
    const auto [entry, is_new] = nearest.try_emplace(cube, squared, row);
    if (!is_new && squared < entry->second.first * (1 - 1e-12)) entry->second = {squared, row};
  }
  Indices rows;
  for (const auto& [cube, found] : nearest) rows.push_back(found.second);
  std::sort(rows.begin(), rows.end());
  return rows;
}

TEST(DetectUniform, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u})
    for (const double spacing_pr : {1.5, 3.0, 8.0, 1000.0}) {
      const Points vertices = testing::bumpy_sphere(4, seed).vertices;
      const double resolution = point_resolution(vertices);
      const Keypoints found = detect_uniform(vertices, resolution, {spacing_pr});
      EXPECT_EQ(found.vertices, reference_uniform(vertices, spacing_pr * resolution)) << spacing_pr;
      EXPECT_EQ(found.candidates, 2562);
      EXPECT_EQ(found.vertices.size() == 1, spacing_pr == 1000);
    }
  for (const testing::PointSet& set : testing::hard_point_sets())
    // Beyond 2^62 cubes they are counted in another way; of tenths on the faces of cubes rounding decides.
    if (set.name.find("outlier") == std::string::npos && set.name.find("tenths") == std::string::npos) {
      EXPECT_EQ(detect_uniform(set.points, 1, {set.unit}).vertices, reference_uniform(set.points, set.unit))
          << set.name;
    }
}

TEST(DetectUniform, OneVertexPerCubeNextToItsMiddle) {
  EXPECT_THAT(
      detect_uniform(points_of({{0, 0, 0}, {0.9, 1.1, 1}, {1.9, 1.9, 1.9}, {2.0, 0, 0}, {3, 1, 1}}), 1, {2}).vertices,
      ElementsAre(1, 4));
  EXPECT_THAT(detect_uniform(points_of({{0, 0, 0}, {0.9, 1.1, 1}, {3, 1, 1}}), 0.5, {4}).vertices, ElementsAre(1, 2))
      << "the spacing is in pr";
}

TEST(DetectUniform, TiesGoToTheLowerIndex) {
  // The corner of the box, and two as far from the middle of its cube as each other.
  EXPECT_THAT(detect_uniform(points_of({{0, 0, 0}, {0.5, 1, 1}, {1.5, 1, 1}}), 1, {2}).vertices, ElementsAre(1));
  EXPECT_THAT(detect_uniform(points_of({{1.5, 1, 1}, {0, 0, 0}, {0.5, 1, 1}}), 1, {2}).vertices, ElementsAre(0));
  EXPECT_THAT(detect_uniform(Points::Ones(30, 3), 1, {2}).vertices, ElementsAre(0));
}

TEST(DetectUniform, NumberingDoesNotMatter) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const Indices old_row = testing::shuffled_rows(mesh.vertices.rows(), 4);
  const Keypoints found = detect_uniform(testing::renumbered(mesh, old_row).vertices, 1, {0.2});
  EXPECT_EQ(testing::by_old_name(found.vertices, old_row), detect_uniform(mesh.vertices, 1, {0.2}).vertices);
}

TEST(DetectUniform, NoVerticesGiveNone) { EXPECT_THAT(detect_uniform(Points(0, 3), 1, {2}).vertices, IsEmpty()); }

TEST(DetectUniform, LengthsAreChecked) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(detect_uniform(Points::Ones(3, 3), bad, {1}), InvalidInput);
    EXPECT_THROW(detect_uniform(Points::Ones(3, 3), 1, {bad}), InvalidInput);
  }
}

}  // namespace
}  // namespace corral
