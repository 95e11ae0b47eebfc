// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/bounding_box.h"
#include "kernel/surface/harris_mesh.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// On a 5 x 5 grid with a spacing of 1: the vertices selected of given responses; the rest have none.
Indices selected(const std::vector<std::pair<int, double>>& given, const HarrisMeshOptions& options,
                 int candidates = -1) {
  Eigen::VectorXd response = Eigen::VectorXd::Constant(25, NAN);
  for (const auto& [row, value] : given) response(row) = value;
  const Keypoints keypoints = select_harris_mesh(testing::grid(5, 5), response, options);
  if (candidates >= 0) {
    EXPECT_EQ(keypoints.candidates, candidates);
  }
  return keypoints.vertices;
}

TEST(SelectHarrisMesh, CandidatesAreLargestOfTheirRing) {
  HarrisMeshOptions options;
  options.fraction = 1;
  // Diagonals run from 12 to 18, not from 12 to 16.
  EXPECT_THAT(selected({{12, 2.0}, {18, 1.0}, {16, 1.0}}, options), ElementsAre(12, 16));
  EXPECT_THAT(selected({{12, 1.0}, {13, 1.0}, {18, 1.0}, {24, 1.0}}, options), ElementsAre(12));
  EXPECT_THAT(selected({{0, 1e-20}, {10, 0.99e-20}, {20, -1.0}, {4, 0.0}}, options), ElementsAre(0));
  EXPECT_THAT(selected({}, options, 0), IsEmpty());
}

TEST(SelectHarrisMesh, FractionIsOfTheVerticesAndAtMostTheCandidates) {
  const std::vector<std::pair<int, double>> given = {{0, 1}, {2, 3}, {4, 2}, {10, 3}, {14, 3}, {22, 0.5}};
  HarrisMeshOptions options;
  const auto keep = [&](double share) {
    options.fraction = share;
    return selected(given, options, 6);
  };
  EXPECT_THAT(keep(0.01), IsEmpty());
  EXPECT_THAT(keep(0.03), ElementsAre(2));  // 0.75 of a vertex
  EXPECT_THAT(keep(0.08), ElementsAre(2, 10));
  EXPECT_THAT(keep(0.16), ElementsAre(2, 4, 10, 14));
  EXPECT_THAT(keep(0.24), ElementsAre(0, 2, 4, 10, 14, 22));
  EXPECT_THAT(keep(1), ElementsAre(0, 2, 4, 10, 14, 22));
}

TEST(SelectHarrisMesh, ClusteringKeepsTheBestOfWhatIsNear) {
  const std::vector<std::pair<int, double>> given = {{0, 1}, {2, 3}, {4, 2}, {14, 4}, {20, 0.5}, {22, 0.5}};
  HarrisMeshOptions options;
  options.selection = MeshSelection::Clustering;
  const auto keep = [&](double distance) {
    options.separation = distance / std::sqrt(32.0);
    return selected(given, options, 6);
  };
  EXPECT_THAT(keep(1.99), ElementsAre(0, 2, 4, 14, 20, 22));
  // 14 drops 4, which can then drop nothing; 2 drops 0; 20 drops 22, which is no better.
  EXPECT_THAT(keep(2.01), ElementsAre(2, 14, 20));
  EXPECT_THAT(keep(3), ElementsAre(0, 14, 20));  // 2 goes, sqrt(8) from 14, and 0 stays
  EXPECT_THAT(keep(9), ElementsAre(14));
}

TEST(SelectHarrisMesh, EqualDistanceIsNotFarther) {
  Mesh mesh = testing::grid(5, 5);
  mesh.vertices.row(24) << 4, 3, 4;  // the diagonal is 4 sqrt 3; 24 joins nothing that matters
  mesh.vertices.row(20) << 3, 0, 0;
  Eigen::VectorXd response = Eigen::VectorXd::Constant(25, NAN);
  response(0) = 2;
  response(3) = 1;
  HarrisMeshOptions options;
  options.selection = MeshSelection::Clustering;
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  options.separation = 3 / diagonal;
  ASSERT_GE(options.separation * diagonal, 3);
  EXPECT_THAT(select_harris_mesh(mesh, response, options).vertices, ElementsAre(0));
  options.separation = std::nextafter(3.0, 0) / diagonal - 1e-16;
  EXPECT_THAT(select_harris_mesh(mesh, response, options).vertices, ElementsAre(0, 3));
}

}  // namespace
}  // namespace corral
