// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/surface/harris_mesh.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/harris_mesh_cases.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/harris_mesh.h"

namespace corral {
namespace {

using testing::count_absent;
using testing::expect_close;
using ::testing::IsEmpty;
using testing::kNeighborhoods;
using testing::noisy_grid;
using testing::options_of;

/// A grid lifted to some height above each of its vertices; the one in the middle is at the origin.
template <class Height>
Mesh lifted(int side, double spacing, Height&& height) {
  Mesh mesh = testing::grid(2 * side + 1, 2 * side + 1, spacing);
  mesh.vertices.leftCols(2).array() -= side * spacing;
  for (int row = 0; row < mesh.vertices.rows(); ++row)
    mesh.vertices(row, 2) = height(mesh.vertices(row, 0), mesh.vertices(row, 1));
  return mesh;
}

TEST(HarrisMeshResponse, AgreesWithTheReference) {
  for (const Mesh& mesh : {testing::bumpy_sphere(3, 1), testing::bumpy_sphere(4, 2), testing::icosphere(3),
                           noisy_grid(3), noisy_grid(4)}) {
    const double resolution = point_resolution(mesh.vertices);
    for (const MeshNeighborhood neighborhood : kNeighborhoods) {
      SCOPED_TRACE(choice_text(neighborhood));
      const HarrisMeshOptions options = options_of(neighborhood);
      const Eigen::VectorXd expected = testing::reference_harris_mesh_response(mesh, resolution, options);
      expect_close(harris_mesh_response(mesh, resolution, options), expected);
      EXPECT_LT(count_absent(expected), mesh.vertices.rows() / 2);
    }
  }
}

TEST(HarrisMeshResponse, AgreesWithTheReferenceForAnyReach) {
  const Mesh mesh = noisy_grid(5);
  for (int step = 1; step <= 4; ++step) {
    HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
    options.rings = step;
    expect_close(harris_mesh_response(mesh, 1, options), testing::reference_harris_mesh_response(mesh, 1, options));
    options.neighborhood = MeshNeighborhood::Ball;
    options.radius_pr = 0.9 * step;
    expect_close(harris_mesh_response(mesh, 1, options), testing::reference_harris_mesh_response(mesh, 1, options));
    options.neighborhood = MeshNeighborhood::Adaptive;
    options.extent = 0.03 * step;
    options.k = 0.06 * step - 0.01;
    expect_close(harris_mesh_response(mesh, 1, options), testing::reference_harris_mesh_response(mesh, 1, options));
  }
}

TEST(HarrisMeshResponse, IsZeroOnAPlane) {
  for (const MeshNeighborhood neighborhood : kNeighborhoods) {
    Mesh mesh = testing::grid(12, 12);
    mesh = move_mesh(mesh, random_motion(mesh, 1));
    HarrisMeshOptions options = options_of(neighborhood);
    options.extent = 0.1;
    const Eigen::VectorXd response = harris_mesh_response(mesh, 1, options);
    EXPECT_EQ(count_absent(response), 0);
    EXPECT_LT(response.cwiseAbs().maxCoeff(), 1e-40) << choice_text(neighborhood);
    options.fraction = 1;
    EXPECT_THAT(detect_harris_mesh(mesh, 1, options).vertices, IsEmpty());
  }
}

TEST(HarrisMeshResponse, OfAQuadraticPatchIsKnown) {
  // Around the origin the fit is the patch itself: in lengths of the reach r, p1 = 2 a r, p3 = 2 b r, p2 = p4 = p5 = 0.
  for (const auto& [a, b] : {std::pair{0.05, 0.05}, {0.08, 0.03}, {0.06, -0.04}, {-0.07, 0.0}}) {
    const Mesh mesh = lifted(6, 0.5, [a = a, b = b](double x, double y) { return a * x * x + b * y * y; });
    const auto squared_length = [a = a, b = b](double x, double y) {
      return x * x + y * y + std::pow(a * x * x + b * y * y, 2);
    };
    HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
    // The farthest of two rings is across two diagonals; of a ball of radius 1.02 it lies on one of the axes.
    for (const MeshNeighborhood neighborhood : {MeshNeighborhood::Rings, MeshNeighborhood::Ball}) {
      options.neighborhood = neighborhood;
      options.radius_pr = 1.02;
      const bool rings = neighborhood == MeshNeighborhood::Rings;
      const double squared_reach = rings ? squared_length(1, 1) : std::max(squared_length(1, 0), squared_length(0, 1));
      const double p1 = 4 * a * a * squared_reach, p3 = 4 * b * b * squared_reach;  // squared
      const double expected = 4 * p1 * p3 - options.k * std::pow(2 * p1 + 2 * p3, 2);
      const double found = harris_mesh_response(mesh, 1, options)(mesh.vertices.rows() / 2);
      EXPECT_NEAR(found, expected, 1e-12 * std::abs(expected)) << choice_text(neighborhood) << " " << a << " " << b;
    }
  }
}

TEST(HarrisMeshResponse, OfACylinderIsMinusKTimesTheSquaredTrace) {
  // One ring sees three places around the axis, which lie on a parabola: p1 = 2 s r / w^2 for a rise s over a width w.
  const double angle = 0.2, radius = 3;
  Mesh mesh = testing::grid(9, 9);
  for (int row = 0; row < mesh.vertices.rows(); ++row) {
    const double turn = angle * mesh.vertices(row, 0);
    mesh.vertices.row(row) << radius * std::sin(turn), mesh.vertices(row, 1), radius * std::cos(turn);
  }
  HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
  options.rings = 1;
  const double width = radius * std::sin(angle), rise = radius * (1 - std::cos(angle));
  const double reach = std::sqrt(width * width + rise * rise + 1);
  const double p1 = 2 * rise * reach / (width * width);
  const Eigen::VectorXd response = harris_mesh_response(mesh, 1, options);
  for (int row = 1; row < 8; ++row)
    for (int column = 1; column < 8; ++column)
      EXPECT_NEAR(response(9 * row + column), -options.k * std::pow(2 * p1 * p1, 2), 1e-12);
  EXPECT_EQ(detect_harris_mesh(mesh, 1, options).candidates, 0);
}

TEST(HarrisMeshResponse, IsAbsentWithoutAPatch) {
  // The corners of a grid: 3 or 4 vertices within one ring, 4 or 5 at its sides; 7 inside.
  HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
  options.rings = 1;
  const Mesh rough = noisy_grid(6);
  const Eigen::VectorXd response = harris_mesh_response(rough, 1, options);
  EXPECT_EQ(count_absent(response), 2 * 24 + 2 * 18);
  EXPECT_FALSE(std::isnan(response(24 + 1)));
  // Two rows lie on one conic: no quadratic is the nearest, nor is one where rounding moves them off it.
  options.rings = 9;
  Mesh strip = testing::grid(10, 2, 0.7);
  EXPECT_EQ(count_absent(harris_mesh_response(strip, 1, options)), 20);
  for (const double far : {0.0, 1e3, 1e4}) {
    RigidTransform motion = random_motion(strip, 7);
    motion.translation.array() += far;
    EXPECT_EQ(count_absent(harris_mesh_response(move_mesh(strip, motion), 1, options)), 20);
  }
}

TEST(HarrisMeshResponse, IsAbsentWithoutADirectionOfLeastVariance) {
  // The whole of a sphere, and of one drawn out along z: all directions across have one variance. Flattened, z has less.
  HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
  options.rings = 99;
  for (const double stretch : {1.0, 3.0, 0.5}) {
    Mesh mesh = testing::icosphere(2);
    mesh.vertices.col(2) *= stretch;
    const int absent = stretch < 1 ? 0 : 162;
    EXPECT_EQ(count_absent(harris_mesh_response(mesh, 1, options)), absent);
    mesh = move_mesh(mesh, random_motion(mesh, 8));
    EXPECT_EQ(count_absent(harris_mesh_response(mesh, 1, options)), absent);
  }
}

}  // namespace
}  // namespace corral
