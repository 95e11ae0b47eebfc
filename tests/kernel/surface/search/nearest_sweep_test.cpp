// SPDX-License-Identifier: MIT
// Normals and resolution where the nearest vertices are hard to find: crowds, outliers, ties, hardly any vertices.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/surface.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::PointSet;

/// Whether a normal is what the k nearest (of equals the lower rows) ask for: unit length and no direction with less
/// variance; zero where they lie on one line.
void expect_fits(const Points& points, int row, int k, const Eigen::RowVector3d& normal) {
  const auto nearest = testing::reference_nearest(points, points.row(row).transpose(), k);
  Eigen::MatrixXd offsets(static_cast<Eigen::Index>(nearest.size()), 3);
  for (std::size_t i = 0; i < nearest.size(); ++i)
    offsets.row(static_cast<Eigen::Index>(i)) = points.row(nearest[i].index) - points.row(row);
  const Eigen::RowVector3d mean = offsets.colwise().mean();
  offsets.rowwise() -= mean;
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(offsets).singularValues();
  variances.head(singular.size()) = singular.cwiseAbs2();
  const double middle_share = variances(0) > 0 ? variances(1) / variances(0) : 0;
  if (middle_share < 1e-13) {
    ASSERT_TRUE(normal.isZero(0)) << row;
  } else if (middle_share > 1e-11) {
    ASSERT_NEAR(normal.norm(), 1, 1e-12) << row;
  }
  ASSERT_LE((offsets * normal.transpose()).squaredNorm(), variances(2) + 1e-12 * variances(0)) << row;
  ASSERT_LE(normal.dot(points.row(row)), 1e-15 * points.row(row).norm()) << "towards the origin";
}

TEST(NearestSweep, NormalsFitTheNearestHoweverThePointsLie) {
  for (const PointSet& set : testing::hard_point_sets())
    for (const int k : {3, 6, 20, 100}) {
      SCOPED_TRACE(set.name + ", k = " + std::to_string(k));
      const Points normals = estimate_normals({set.points, Triangles(0, 3)}, {k});
      for (int row = 0; row < normals.rows(); row += 3) expect_fits(set.points, row, k, normals.row(row));
    }
}

TEST(NearestSweep, ResolutionsAgreeHoweverThePointsLie) {
  int measured = 0;
  for (const PointSet& set : testing::hard_point_sets()) {
    if (set.points.rows() < 2 || set.name == "all in one place") {
      EXPECT_THROW(point_resolution(set.points), InvalidInput) << set.name;
      continue;
    }
    const double expected = testing::reference_resolution(set.points);
    EXPECT_NEAR(point_resolution(set.points), expected, 1e-12 * expected) << set.name;
    ++measured;
  }
  EXPECT_GT(measured, 15);
}

TEST(NearestSweep, NormalsAndResolutionAtOnceAreTheSameBits) {
  for (const PointSet& set : testing::hard_point_sets())
    for (const int k : {3, 20}) {
      SCOPED_TRACE(set.name + ", k = " + std::to_string(k));
      const Mesh mesh{set.points, Triangles(0, 3)};
      if (set.points.rows() < 2 || set.name == "all in one place") {
        EXPECT_THROW(estimate_normals_and_resolution(mesh, {k}), InvalidInput);
        continue;
      }
      const NormalsAndResolution found = estimate_normals_and_resolution(mesh, {k}, testing::on_three_threads);
      EXPECT_TRUE(found.normals == estimate_normals(mesh, {k}));
      EXPECT_EQ(found.spacing.resolution, point_resolution(set.points));
    }
}

/// So many in a crowd that no cell around it is looked through;
Points with_a_crowd(int in_crowd, int elsewhere) {
  return testing::stacked({testing::uniform_points(elsewhere / 2, 1), 1e-6 * testing::uniform_points(in_crowd, 2),
                           testing::uniform_points(elsewhere / 2, 3), testing::points_of({{77, 1, 0}, {0, -30, 1}})});
}

TEST(NearestSweep, CrowdsAreSearchedWithATree) {
  const Points points = with_a_crowd(6000, 800);
  const Points normals = estimate_normals({points, Triangles(0, 3)});
  for (int row = 0; row < points.rows(); row += row < 400 || row > 6300 ? 20 : 400)
    expect_fits(points, row, 20, normals.row(row));
  for (const Eigen::Index row : {points.rows() - 2, points.rows() - 1})
    expect_fits(points, static_cast<int>(row), 20, normals.row(row));
  const double expected = testing::reference_resolution(points);
  EXPECT_NEAR(point_resolution(points), expected, 1e-12 * expected);
}

TEST(NearestSweep, SmallerCrowdsAreSearchedAllWithAll) {
  const Points points = with_a_crowd(4300, 400);
  const Points normals = estimate_normals({points, Triangles(0, 3)});
  for (int row = 0; row < points.rows(); row += row < 200 || row > 4490 ? 20 : 300)
    expect_fits(points, row, 20, normals.row(row));
  const double expected = testing::reference_resolution(points);
  EXPECT_NEAR(point_resolution(points), expected, 1e-12 * expected);
}

TEST(NearestSweep, ThousandsInOnePlaceCountOnce) {
  for (const int copies : {4300, 9000, 100000}) {
    const Points others = testing::uniform_points(700, 4);
    const Points points = testing::stacked({others, others.row(5).replicate(copies, 1)});
    EXPECT_EQ(point_resolution(points), point_resolution(others)) << copies;
    const auto [normals, spacing] = estimate_normals_and_resolution({points, Triangles(0, 3)});
    EXPECT_EQ(spacing.resolution, point_resolution(others)) << copies;
    EXPECT_TRUE(normals.row(5).isZero(0)) << "its nearest are its copies";
    for (int row = 0; row < 700; row += 50) expect_fits(points, row, 20, normals.row(row));
  }
}

/// Middles, each first of its thirty points about as far away, which differ by a share of that.
Points shells(int count, double spread) {
  RandomStream random(11);
  Points points(31 * count, 3);
  for (int row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3d middle(9.0 * (row / 31), 0.3 * (row / 31), 5);
    const double distance = row % 31 == 0 ? 0 : 1 + spread * random.uniform(0, 1);
    points.row(row) = middle + distance * random.direction().transpose();
  }
  return points;
}

TEST(NearestSweep, DecidesWhatFloatsCannotTellApart) {
  constexpr int kShells = 40;
  for (const double spread : {1e-12, 1e-9, 1e-7, 3e-7, 1e-6, 1e-5, 1e-3}) {
    SCOPED_TRACE(spread);
    const Points points = shells(kShells, spread);
    for (const std::int64_t each : testing::available_targets()) {
      const testing::ForcedTarget forced(each);
      const Points normals = estimate_normals({points, Triangles(0, 3)});
      for (int row = 0; row < points.rows(); row += 31) expect_fits(points, row, 20, normals.row(row));
    }
  }
}

TEST(NearestSweep, EqualDistancesGoToTheLowerRows) {
  // Around the middle of a lattice: itself, 6 at distance 1, and of the 12 at sqrt 2 the 3 with the lowest rows. The middle
  // comes first in one numbering, last in another.
  for (const bool middle_first : {true, false}) {
    std::vector<testing::Row3> rows = {{0, 0, 0}, {1, 0, 0},  {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1},
                                       {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {0, 1, 1}, {0, 1, -1}, {1, 0, 1}, {-1, 0, 1}};
    if (!middle_first) std::swap(rows.front(), rows.back());
    Points points = testing::points_of(rows);
    points.col(2).array() -= 100;
    const Points normals = estimate_normals({points, Triangles(0, 3)}, {10});
    const Eigen::RowVector3d normal = normals.row(middle_first ? 0 : 13);
    // In the first numbering those three lie in the plane z = 0: its variance, 2, is less than those along x and y.
    if (middle_first) {
      EXPECT_NEAR(normal.z(), 1, 1e-12);
    }
    for (int row = 0; row < 14; ++row) expect_fits(points, row, 10, normals.row(row));
  }
}

}  // namespace
}  // namespace corral
