// SPDX-License-Identifier: MIT
#include "kernel/surface/harris.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/surface.h"
#include "tests/support/renumbering.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Keypoints detect(const Mesh& mesh, double resolution, const HarrisOptions& options = {}) {
  return detect_harris(mesh.vertices, resolution, options);
}

double largest_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// The surface of the cube [-side, side]^3, sampled at whole coordinates.
Points cube_surface(int side) {
  std::vector<Eigen::RowVector3d> places;
  for (int x = -side; x <= side; ++x)
    for (int y = -side; y <= side; ++y)
      for (int z = -side; z <= side; ++z)
        if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == side) places.emplace_back(x, y, z);
  Points points(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t i = 0; i < places.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = places[i];
  return points;
}

/// The most outstanding of the rows that satisfy a condition.
template <class Condition>
double largest_where(const Points& points, const Eigen::VectorXd& values, Condition&& condition) {
  double largest = -1;
  for (int row = 0; row < points.rows(); ++row)
    if (condition(Eigen::Vector3d(points.row(row).transpose()))) largest = std::max(largest, values(row));
  return largest;
}

TEST(HarrisResponse, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Points vertices = testing::bumpy_sphere(4, seed).vertices;
    const double radius = 3 * point_resolution(vertices);
    const Eigen::VectorXd response = harris_response(vertices, radius);
    EXPECT_LT(largest_difference(response, testing::reference_harris_response(vertices, radius)), 1e-9);
    EXPECT_GT(response.maxCoeff(), 1e-4);
    EXPECT_GE(response.minCoeff(), -1e-15);
    EXPECT_LE(response.maxCoeff(), 1.0 / 27);
  }
}

/// Steps of random heights over a lattice of tenths: many vertices lie exactly as far from each other as a radius of tenths.
Points terraces(std::uint64_t seed) {
  RandomStream random(seed);
  Points points(400, 3);
  for (int row = 0; row < 400; ++row)
    points.row(row) << 0.1 * (row % 20), 0.1 * (row / 20), 0.04 * static_cast<double>(random.below(3));
  return points;
}

TEST(HarrisResponse, VerticesExactlyAtTheRadiusCount) {
  // Far outliers leave few digits for the place of a vertex among the cells.
  for (const double far : {0.0, 1e3, -1e6, 1e9, -1e13, 1e18})
    for (const double radius : {0.1, 0.2, 0.3, 0.5}) {
      const Points points = testing::stacked({terraces(1), testing::points_of({{far, far, far}, {0, -far, 0}})});
      const Eigen::VectorXd difference =
          harris_response(points, radius) - testing::reference_harris_response(points, radius);
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << far << " " << radius;
    }
}

TEST(HarrisResponse, IsZeroOnFlatGroundAndAlongACylinder) {
  const Mesh flat = testing::grid(15, 15);
  EXPECT_LT(harris_response(flat.vertices, 3).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(harris_response(move_mesh(flat, random_motion(flat, 1)).vertices, 3.1).cwiseAbs().maxCoeff(), 1e-15);
  Points cylinder(30 * 20, 3);
  for (int row = 0; row < cylinder.rows(); ++row) {
    const double angle = 2 * std::acos(-1.0) * (row % 30) / 30;
    cylinder.row(row) << 5 * std::cos(angle), 5 * std::sin(angle), row / 30;
  }
  // Away from the open ends all normals are at right angles to the axis: the determinant is zero.
  const Eigen::VectorXd response = harris_response(cylinder, 2.5);
  EXPECT_LT(largest_where(cylinder, response, [](const Eigen::Vector3d& x) { return x.z() > 5.5 && x.z() < 13.5; }),
            1e-15);
}

TEST(HarrisResponse, CornersStandOutOnACube) {
  const Points points = cube_surface(8);
  const Eigen::VectorXd response = harris_response(points, 3);
  const auto at_limit = [](const Eigen::Vector3d& x) { return (x.array().abs() == 8).count(); };
  const double corner = largest_where(points, response, [&](const Eigen::Vector3d& x) { return at_limit(x) == 3; });
  const double edge = largest_where(
      points, response, [&](const Eigen::Vector3d& x) { return at_limit(x) == 2 && x.cwiseAbs().minCoeff() <= 1; });
  const double face = largest_where(
      points, response, [&](const Eigen::Vector3d& x) { return at_limit(x) == 1 && x.cwiseAbs().sum() <= 9; });
  EXPECT_GT(corner, 0.005);
  EXPECT_LT(edge, 1e-15);
  EXPECT_LT(face, 1e-15);
}

TEST(HarrisResponse, ThreeOrthogonalPlanesReachTheLimit) {
  // Within 1 of the first vertex lie two others, and each of these has one more: three planes across the three axes, and
  // two vertices at the ends that see too little for a normal.
  const Points points = testing::points_of({{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.5, 0, 1.5}, {0.5, 1.5, 0}});
  const Eigen::VectorXd response = harris_response(points, 1);
  EXPECT_NEAR(response(0), 1.0 / 27, 1e-15);  // A = I / 3
  EXPECT_LT(response.tail(4).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(HarrisResponse, VerticesWithoutANormalAreLeftOut) {
  EXPECT_EQ(harris_response(Points::Zero(1, 3), 1)(0), 0);
  EXPECT_EQ(harris_response(Points::Zero(50, 3), 1).cwiseAbs().maxCoeff(), 0);
  Points line = Points::Zero(30, 3);
  for (int row = 0; row < 30; ++row) line.row(row) = (0.1 * row + 1) * Eigen::RowVector3d(1, -2, 0.3);
  EXPECT_EQ(harris_response(line, 1.5).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(harris_response(line.array() + 1e3, 1.5).cwiseAbs().maxCoeff(), 0);
}

TEST(HarrisResponse, RigidMotionDoesNotChangeIt) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const double radius = 3 * point_resolution(mesh.vertices);
  const Mesh moved = move_mesh(mesh, random_motion(mesh, 4));
  EXPECT_LT(largest_difference(harris_response(mesh.vertices, radius), harris_response(moved.vertices, radius)), 1e-9);
}

TEST(DetectHarris, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    const double resolution = point_resolution(mesh.vertices);
    HarrisOptions options;
    for (const double radius_pr : {2.0, 3.0, 4.5}) {
      options.radius_pr = radius_pr;
      const Keypoints found = detect(mesh, resolution, options);
      const Keypoints expected = testing::reference_harris(mesh.vertices, resolution, options);
      EXPECT_EQ(found.vertices, expected.vertices);
      EXPECT_EQ(found.candidates, expected.candidates);
      EXPECT_GT(found.vertices.size(), 5u);
    }
  }
}

TEST(DetectHarris, FlatGroundHasNone) {
  const Keypoints none = detect(testing::grid(20, 20), 1);
  EXPECT_THAT(none.vertices, IsEmpty());
  EXPECT_EQ(none.candidates, 0);
}

TEST(DetectHarris, EqualResponsesGoToTheLowerIndex) {
  // Every vertex twice: the two copies tie exactly.
  Mesh mesh = testing::bumpy_sphere(3, 6);
  const double resolution = point_resolution(mesh.vertices);
  const Indices single = detect(mesh, resolution).vertices;
  const Eigen::Index count = mesh.vertices.rows();
  mesh.vertices = mesh.vertices.replicate(2, 1).eval();
  const Keypoints doubled = detect(mesh, resolution);
  EXPECT_EQ(doubled.vertices, single);
  EXPECT_LT(doubled.vertices.back(), count);
}

TEST(DetectHarris, RigidMotionKeepsTheKeypoints) {
  for (const std::uint64_t seed : {7u, 8u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    const double resolution = point_resolution(mesh.vertices);
    EXPECT_EQ(detect(move_mesh(mesh, random_motion(mesh, seed)), resolution).vertices,
              detect(mesh, resolution).vertices);
  }
}

TEST(DetectHarris, PermutedVerticesGiveThePermutedKeypoints) {
  const Mesh mesh = testing::bumpy_sphere(4, 9);
  const double resolution = point_resolution(mesh.vertices);
  const Indices old_row = testing::shuffled_rows(mesh.vertices.rows(), 10);
  const Keypoints found = detect(testing::renumbered(mesh, old_row), resolution);
  EXPECT_EQ(testing::by_old_name(found.vertices, old_row), detect(mesh, resolution).vertices);
}

TEST(DetectHarris, MostKeypointsComeBackUnderNoise) {
  double right = 0, near = 0, at = 0, all = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Mesh mesh = testing::bumpy_sphere(5, seed);
    const double resolution = point_resolution(mesh.vertices);
    const Mesh noisy = add_gaussian_noise(mesh, 0.05 * resolution, seed);
    const PointIndex repeated(noisy.vertices(detect(noisy, resolution).vertices, Eigen::all));
    for (const int row : detect(mesh, resolution).vertices) {
      const auto nearest = repeated.nearest(mesh.vertices.row(row).transpose(), 1);
      ASSERT_EQ(nearest.size(), 1u);
      at += nearest[0].squared_distance <= resolution * resolution;
      near += nearest[0].squared_distance <= 9 * resolution * resolution;
      right += nearest[0].squared_distance <= 16 * resolution * resolution;
      ++all;
    }
  }
  EXPECT_GT(all, 200);
  EXPECT_GT(right / all, 0.9) << "within 4 pr, the distance of a right match";
  EXPECT_GT(near / all, 0.8) << "within 3 pr";
  EXPECT_GT(at / all, 0.4) << "within 1 pr";
}

TEST(DetectHarris, TooLittleSurfaceGivesNone) {
  Mesh mesh;
  mesh.vertices = Points::Random(2, 3);
  EXPECT_THAT(detect(mesh, 1).vertices, IsEmpty());
  mesh.vertices = Points::Ones(2000, 3);
  EXPECT_THAT(detect(mesh, 1).vertices, IsEmpty());
}

TEST(DetectHarris, NoVerticesGiveNone) {
  EXPECT_EQ(harris_response(Points(0, 3), 1).size(), 0);
  EXPECT_THAT(detect({Points(0, 3), Triangles(0, 3)}, 1).vertices, IsEmpty());
}

TEST(DetectHarris, LengthsAreChecked) {
  const Mesh mesh = testing::icosphere(1);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    HarrisOptions options;
    EXPECT_THROW(detect(mesh, bad), InvalidInput);
    options.radius_pr = bad;
    EXPECT_THROW(detect(mesh, 1, options), InvalidInput);
    EXPECT_THROW(harris_response(mesh.vertices, bad), InvalidInput);
  }
}

}  // namespace
}  // namespace corral
