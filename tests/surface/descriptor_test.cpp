// SPDX-License-Identifier: MIT
#include "kernel/surface/descriptor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/error.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/perturbation.h"
#include "kernel/surface/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/reference_surface.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::points_of;

Eigen::Vector3d vertex_of(const Mesh& mesh, int row) { return mesh.vertices.row(row).transpose(); }

Points normals_of(const Mesh& mesh) { return estimate_normals(mesh, PointIndex(mesh.vertices)); }

std::optional<LocalReferenceFrame> frame_at(const Points& vertices, const Eigen::Vector3d& point, double radius) {
  return shot_frame(vertices, point, PointIndex(vertices).within(point, radius), radius);
}

Indices some_rows(const Mesh& mesh, int step) {
  Indices rows;
  for (int row = 0; row < mesh.vertices.rows(); row += step) rows.push_back(row);
  return rows;
}

Descriptors describe(const Mesh& mesh, const Indices& rows, double resolution, double radius_pr = 15) {
  return describe_shot(mesh, normals_of(mesh), PointIndex(mesh.vertices), rows, resolution, radius_pr);
}

/// The histogram of one neighbour at `place`, its normal at `cosine` to the z axis, in a frame along the axes.
Eigen::VectorXd single(const Eigen::Vector3d& place, double cosine, double radius = 4) {
  Points vertices = Points::Zero(1, 3), normals = Points::Zero(1, 3);
  vertices.row(0) = place.transpose();
  normals.row(0) << std::sqrt(1 - cosine * cosine), 0, cosine;
  const auto histogram = shot_histogram(vertices, normals, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
                                        {{0, place.squaredNorm()}}, radius);
  return histogram.value_or(Eigen::VectorXd::Zero(kShotSize));
}

Eigen::Index bin(int azimuth, int elevation, int shell, int cosine) {
  return ((azimuth * 2 + elevation) * 2 + shell) * 11 + cosine;
}

/// The place at a distance, degrees from +z, and degrees of azimuth.
Eigen::Vector3d polar(double distance, double elevation_deg, double azimuth_deg) {
  const double e = elevation_deg * std::acos(-1.0) / 180, a = azimuth_deg * std::acos(-1.0) / 180;
  return distance * Eigen::Vector3d(std::sin(e) * std::cos(a), std::sin(e) * std::sin(a), std::cos(e));
}

TEST(ShotFrame, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    for (const double radius_pr : {4.0, 15.0}) {
      const double radius = radius_pr * point_resolution(mesh.vertices);
      for (int row = 0; row < mesh.vertices.rows(); row += 13) {
        const auto found = frame_at(mesh.vertices, vertex_of(mesh, row), radius);
        ASSERT_TRUE(found.has_value());
        EXPECT_TRUE(is_valid_frame(*found));
        const auto expected = testing::reference_shot_frame(mesh.vertices, vertex_of(mesh, row), radius);
        EXPECT_LT((*found - *expected).norm(), 1e-9) << row << " " << radius_pr;
      }
    }
  }
}

TEST(ShotFrame, OrderOfTheNeighboursDoesNotMatter) {
  const Mesh mesh = testing::bumpy_sphere(3, 3);
  const double radius = 6 * point_resolution(mesh.vertices);
  auto neighbors = PointIndex(mesh.vertices).within(vertex_of(mesh, 5), radius);
  const auto forward = shot_frame(mesh.vertices, vertex_of(mesh, 5), neighbors, radius);
  std::reverse(neighbors.begin(), neighbors.end());
  EXPECT_LT((*forward - *shot_frame(mesh.vertices, vertex_of(mesh, 5), neighbors, radius)).norm(), 1e-12);
}

TEST(ShotFrame, NeedsFiveNeighboursElsewhere) {
  Points vertices = points_of({{0, 0, 0}, {0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}, {-0.5, 0.2, 0}, {0.1, -0.3, 0.1}});
  EXPECT_FALSE(frame_at(vertices, {0, 0, 0}, 2).has_value());
  vertices.row(1) << 0.2, 0.2, 0.05;
  EXPECT_TRUE(frame_at(vertices, {0, 0, 0}, 2).has_value());
  EXPECT_FALSE(frame_at(vertices, {0, 0, 0}, 0.5).has_value());
  EXPECT_FALSE(frame_at(Points::Zero(40, 3), {0, 0, 0}, 2).has_value());
}

TEST(ShotFrame, TurnsToTheSideWhereMostNeighboursLie) {
  // A flat patch that reaches farther to +x than to -x, bent upward: x = +x, z = +z.
  std::vector<testing::Row3> rows;
  for (int i = -2; i <= 8; ++i)
    for (int j = -1; j <= 1; ++j)
      if (i != 0 || j != 0) rows.push_back({0.5 * i, 0.25 * j, 0.01 * i * i});
  const auto frame = frame_at(points_of(rows), {0, 0, 0}, 10);
  ASSERT_TRUE(frame.has_value());
  EXPECT_GT((*frame)(0, 0), 0.99);
  EXPECT_GT((*frame)(1, 1), 0.99);
  EXPECT_GT((*frame)(2, 2), 0.99);
}

TEST(ShotFrame, EqualSidesAreDecidedAroundTheMedianDistance) {
  // Six neighbours along x, three on each side; by distance the middle five are - - + + +, then with signs turned.
  for (const double side : {1.0, -1.0}) {
    Points vertices = points_of({{-1, 0, 0}, {-2, 0.3, 0}, {-3, -0.2, 0}, {4, 0.1, 0}, {5, 0.1, 0.1}, {6, -0.3, 0.1}});
    vertices.col(0) *= side;
    const auto frame = frame_at(vertices, {0, 0, 0}, 10);
    ASSERT_TRUE(frame.has_value());
    EXPECT_GT(side * (*frame)(0, 0), 0.99);
  }
}

TEST(ShotFrame, MovesAlongWithTheSurface) {
  const Mesh mesh = testing::bumpy_sphere(4, 4);
  const double radius = 15 * point_resolution(mesh.vertices);
  const RigidTransform motion = random_motion(mesh, 5);
  const Mesh moved = move_mesh(mesh, motion);
  for (const int row : some_rows(mesh, 29)) {
    const LocalReferenceFrame expected =
        *frame_at(mesh.vertices, vertex_of(mesh, row), radius) * motion.rotation.transpose();
    EXPECT_LT((*frame_at(moved.vertices, vertex_of(moved, row), radius) - expected).norm(), 1e-9);
  }
}

TEST(ShotFrame, IsFiniteOnFlatAndStraightNeighbourhoods) {
  const Mesh flat = testing::grid(9, 9);
  const auto frame = frame_at(flat.vertices, {4, 4, 0}, 3);
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(is_valid_frame(*frame));
  EXPECT_NEAR(std::abs((*frame)(2, 2)), 1, 1e-12);
  Points line = Points::Zero(20, 3);
  line.col(0).setLinSpaced(0.0, 1.9);
  const auto straight = frame_at(line, {0, 0, 0}, 1.5);
  EXPECT_TRUE(!straight || is_valid_frame(*straight));
}

TEST(ShotHistogram, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    const Points normals = normals_of(mesh);
    const PointIndex index(mesh.vertices);
    for (const double radius_pr : {5.0, 15.0}) {
      const double radius = radius_pr * point_resolution(mesh.vertices);
      for (const int row : some_rows(mesh, 17)) {
        const Eigen::Vector3d point = vertex_of(mesh, row);
        const auto frame = testing::reference_shot_frame(mesh.vertices, point, radius);
        const auto found = shot_histogram(mesh.vertices, normals, point, *frame, index.within(point, radius), radius);
        const auto expected = testing::reference_shot_histogram(mesh.vertices, normals, point, *frame, radius);
        ASSERT_TRUE(found.has_value());
        ASSERT_EQ(found->size(), kShotSize);
        EXPECT_LT((*found - *expected).cwiseAbs().maxCoeff(), 1e-9) << row;
        EXPECT_NEAR(found->norm(), 1, 1e-12);
        EXPECT_GE(found->minCoeff(), 0);
      }
    }
  }
}

TEST(ShotHistogram, CentreOfABinGivesToNoOther) {
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int elevation = 0; elevation < 2; ++elevation)
      for (int shell = 0; shell < 2; ++shell)
        for (int cosine = 0; cosine <= 10; ++cosine) {
          const Eigen::VectorXd histogram =
              single(polar(1 + 2 * shell, 45 + 90 * elevation, -157.5 + 45 * azimuth), 0.2 * cosine - 1);
          EXPECT_NEAR(histogram(bin(azimuth, elevation, shell, cosine)), 1, 1e-12);
          EXPECT_NEAR(histogram.sum(), 1, 1e-12);
        }
}

TEST(ShotHistogram, EachAxisGivesToItsNeighbourByItself) {
  // In home bin (5, 0, 0, 6): 0.1 off in cosine, 0.2 in radius, 0.3 in elevation, 0.4 in azimuth; 3 stay.
  const Eigen::VectorXd histogram = single(polar(1.4, 45 + 27, 67.5 + 18), 0.22);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
  expected(bin(5, 0, 0, 6)) = 0.9 + 0.8 + 0.7 + 0.6;
  expected(bin(5, 0, 0, 7)) = 0.1;
  expected(bin(5, 0, 1, 6)) = 0.2;
  expected(bin(5, 1, 0, 6)) = 0.3;
  expected(bin(6, 0, 0, 6)) = 0.4;
  EXPECT_LT((histogram - expected.normalized()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShotHistogram, WeightBeyondTheOutermostCentresIsLost) {
  // Home bin (0, 1, 1, 10): 0.3 beyond the outer shell, 0.2 below the lower half, azimuth 0.25 towards sector 7.
  const Eigen::VectorXd histogram = single(polar(3.6, 135 + 18, -157.5 - 11.25), 0.92);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
  expected(bin(0, 1, 1, 10)) = 0.6 + 0.7 + 0.8 + 0.75;
  expected(bin(0, 1, 1, 9)) = 0.4;
  expected(bin(7, 1, 1, 10)) = 0.25;
  EXPECT_LT((histogram - expected.normalized()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShotHistogram, LastCosineBinIsNotWrapped) {
  const Eigen::VectorXd histogram = single(polar(1, 45, 22.5), 0.86);  // 9.3: 0.3 to bin 10, none to bin 0
  EXPECT_NEAR(histogram(bin(4, 0, 0, 10)) / histogram(bin(4, 0, 0, 9)), 0.3 / 3.7, 1e-12);
  EXPECT_EQ(histogram(bin(4, 0, 0, 0)), 0);
}

TEST(ShotHistogram, CosineOutsideItsRangeIsClamped) {
  const Points vertices = polar(1, 45, 22.5).transpose(), normals = points_of({{0, 0, 1 + 1e-9}});
  for (const double sign : {1.0, -1.0}) {
    const auto histogram =
        shot_histogram(vertices, sign * normals, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), {{0, 1}}, 4);
    ASSERT_TRUE(histogram.has_value());
    EXPECT_NEAR((*histogram)(bin(4, 0, 0, sign > 0 ? 10 : 0)), 1, 1e-8);
  }
}

TEST(ShotHistogram, EveryPlaceAndNormalFindsABin) {
  const double root = std::sqrt(0.5);
  for (const double x : {-2.0, -root, -0.0, 0.0, root, 2.0})
    for (const double y : {-2.0, -root, -0.0, 0.0, root, 2.0})
      for (const double z : {-2.0, -root, -0.0, 0.0, root, 2.0})
        for (const double cosine : {-1.0, -0.9, -0.1, 0.0, 0.1, 0.9, 1.0}) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Eigen::VectorXd histogram = single({x, y, z}, cosine);
          EXPECT_TRUE(histogram.allFinite());
          EXPECT_NEAR(histogram.norm(), 1, 1e-12) << x << " " << y << " " << z << " " << cosine;
        }
}

TEST(ShotHistogram, IsAbsentWithoutANormal) {
  const Points vertices = testing::icosphere(2).vertices;
  const auto neighbors = PointIndex(vertices).within({0, 0, 1}, 0.9);
  EXPECT_FALSE(
      shot_histogram(vertices, Points::Zero(vertices.rows(), 3), {0, 0, 1}, Eigen::Matrix3d::Identity(), neighbors, 0.9)
          .has_value());
  EXPECT_FALSE(shot_histogram(vertices, vertices, {0, 0, 1}, Eigen::Matrix3d::Identity(), {}, 0.9).has_value());
}

TEST(DescribeShot, PutsFramesAndHistogramsTogether) {
  const Mesh mesh = testing::bumpy_sphere(4, 6);
  const Points normals = normals_of(mesh);
  const double resolution = point_resolution(mesh.vertices);
  const Indices rows{900, 3, 77, 3};
  const Descriptors found = describe(mesh, rows, resolution, 10);
  EXPECT_EQ(found.vertices, rows);
  ASSERT_EQ(found.features.cols(), 4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d point = vertex_of(mesh, rows[i]);
    EXPECT_LT((found.frames[i] - *testing::reference_shot_frame(mesh.vertices, point, 10 * resolution)).norm(), 1e-9);
    EXPECT_LT((found.features.col(static_cast<Eigen::Index>(i)) -
               *testing::reference_shot_histogram(mesh.vertices, normals, point, found.frames[i], 10 * resolution))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9);
  }
}

TEST(DescribeShot, RigidMotionDoesNotChangeTheHistograms) {
  const Mesh mesh = testing::bumpy_sphere(4, 7);
  const double resolution = point_resolution(mesh.vertices);
  const RigidTransform motion = random_motion(mesh, 8);
  const Indices rows = some_rows(mesh, 23);
  const Descriptors here = describe(mesh, rows, resolution),
                    there = describe(move_mesh(mesh, motion), rows, resolution);
  ASSERT_EQ(here.vertices, there.vertices);
  EXPECT_LT((here.features - there.features).cwiseAbs().maxCoeff(), 1e-9);
  for (std::size_t i = 0; i < here.frames.size(); ++i)
    EXPECT_LT((here.frames[i] * motion.rotation.transpose() - there.frames[i]).norm(), 1e-9);
}

TEST(DescribeShot, CountsWhatItDrops) {
  // Row 0 is alone (no frame); the normals around row 1 are zero (no histogram); the others stay.
  Mesh mesh{Points(0, 3), Triangles(0, 3)};
  const Points sphere = testing::bumpy_sphere(3, 9).vertices;
  mesh.vertices.resize(1 + 2 * sphere.rows(), 3);
  mesh.vertices << 500, 0, 0, sphere, sphere.rowwise() + Eigen::RowVector3d(0, 100, 0);
  Points normals = normals_of(mesh);
  normals.middleRows(1, sphere.rows()).setZero();
  const int second = 1 + static_cast<int>(sphere.rows());
  const Descriptors found = describe_shot(mesh, normals, PointIndex(mesh.vertices), {0, 1, second, second + 5}, 0.1, 4);
  EXPECT_THAT(found.vertices, ElementsAre(second, second + 5));
  EXPECT_EQ(found.dropped_no_frame, 1);
  EXPECT_EQ(found.dropped_no_histogram, 1);
  EXPECT_EQ(found.features.cols(), 2);
  EXPECT_EQ(found.frames.size(), 2u);
  const Descriptors none = describe(mesh, {}, 1);
  EXPECT_THAT(none.vertices, IsEmpty());
  EXPECT_EQ(none.features.cols(), 0);
}

TEST(DescribeShot, LengthsAreChecked) {
  const Mesh mesh = testing::icosphere(1);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(describe(mesh, {0}, bad), InvalidInput);
    EXPECT_THROW(describe(mesh, {0}, 1, bad), InvalidInput);
  }
}

/// The histogram of one neighbour under the identity frame, before its length is made one: divide by the entry of its bin.
Eigen::VectorXd histogram_of(const Eigen::Vector3d& neighbor, double radius) {
  Points vertex(1, 3), normal(1, 3);
  vertex.row(0) = neighbor.transpose();
  normal.row(0) << 0, 0, 1;  // cosine 1: the last cosine bin, without a share
  return shot_histogram(vertex, normal, Eigen::Vector3d::Zero(), LocalReferenceFrame::Identity(),
                        {{0, neighbor.squaredNorm()}}, radius)
      .value();
}

int bin(int azimuth, int elevation, int shell) { return ((azimuth * 2 + elevation) * 2 + shell) * 11 + 10; }

// Beyond the last centre of an axis that ends there is nobody to share with: half of that vote is lost.
TEST(ShotHistogram, TheRimGivesNothingToTheInnerShell) {
  const Eigen::VectorXd rim = histogram_of({2, 0, 0}, 2);
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int elevation = 0; elevation < 2; ++elevation)
      EXPECT_EQ(rim(bin(azimuth, elevation, 0)), 0) << azimuth << " " << elevation;
}

TEST(ShotHistogram, StraightDownGivesNothingToTheUpperHalf) {
  const Eigen::VectorXd down = histogram_of({0, 0, -1.5}, 2);
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int shell = 0; shell < 2; ++shell) EXPECT_EQ(down(bin(azimuth, 0, shell)), 0) << azimuth << " " << shell;
}

}  // namespace
}  // namespace corral
