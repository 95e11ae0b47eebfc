// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/perturbation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

TEST(AddGaussianNoise, HasTheDeviationOnEveryCoordinate) {
  const Mesh mesh = testing::icosphere(6);  // 40962 vertices
  const double deviation = 0.03;
  const Points noise = add_gaussian_noise(mesh, deviation, 1).vertices - mesh.vertices;
  const auto count = static_cast<double>(noise.rows());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::ArrayXd unit = noise.col(axis).array() / deviation;
    // Five standard errors of the mean, the variance, the third and the fourth moment of a normal sample.
    EXPECT_NEAR(unit.mean(), 0, 5 / std::sqrt(count));
    EXPECT_NEAR(unit.square().mean(), 1, 5 * std::sqrt(2 / count));
    EXPECT_NEAR(unit.cube().mean(), 0, 5 * std::sqrt(15 / count));
    EXPECT_NEAR(unit.square().square().mean(), 3, 5 * std::sqrt(96 / count));
    const Eigen::ArrayXd other = noise.col((axis + 1) % 3).array() / deviation;
    EXPECT_NEAR((unit * other).mean(), 0, 5 / std::sqrt(count));
  }
  // A coordinate is independent of the one before it in the same column, too.
  const auto last = noise.rows() - 1;
  EXPECT_NEAR((noise.col(0).head(last).array() * noise.col(0).tail(last).array()).mean() / (deviation * deviation), 0,
              5 / std::sqrt(count));
}

TEST(AddGaussianNoise, KeepsTheTrianglesAndTheOrder) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  const Mesh noisy = add_gaussian_noise(mesh, 1e-6, 2);
  EXPECT_EQ(noisy.triangles, mesh.triangles);
  ASSERT_EQ(noisy.vertices.rows(), mesh.vertices.rows());
  EXPECT_LT((noisy.vertices - mesh.vertices).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NE(noisy.vertices, mesh.vertices);
}

TEST(AddGaussianNoise, SeedDecides) {
  const Mesh mesh = testing::icosphere(2);
  EXPECT_EQ(add_gaussian_noise(mesh, 0.1, 3).vertices, add_gaussian_noise(mesh, 0.1, 3).vertices);
  EXPECT_NE(add_gaussian_noise(mesh, 0.1, 3).vertices, add_gaussian_noise(mesh, 0.1, 4).vertices);
}

TEST(AddGaussianNoise, OfNoDeviationIsACopy) {
  const Mesh mesh = testing::icosphere(2);
  EXPECT_EQ(add_gaussian_noise(mesh, 0, 5).vertices, mesh.vertices);
  EXPECT_EQ(add_gaussian_noise({Points(0, 3), Triangles(0, 3)}, 1, 5).vertices.rows(), 0);
}

TEST(AddGaussianNoise, DeviationIsChecked) {
  for (const double bad : {-1e-9, std::nan(""), HUGE_VAL, -HUGE_VAL})
    EXPECT_THROW(add_gaussian_noise(testing::icosphere(0), bad, 1), InvalidInput);
}

TEST(MoveMesh, MovesEveryVertexAndKeepsTheTriangles) {
  const Mesh mesh = testing::bumpy_sphere(2, 2);
  const RigidTransform motion = random_motion(mesh, 6);
  const Mesh moved = move_mesh(mesh, motion);
  EXPECT_EQ(moved.triangles, mesh.triangles);
  for (int row = 0; row < mesh.vertices.rows(); ++row)
    EXPECT_LT(
        (moved.vertices.row(row).transpose() - motion * Eigen::Vector3d(mesh.vertices.row(row).transpose())).norm(),
        1e-14);
  EXPECT_LT((move_mesh(moved, motion.inverse()).vertices - mesh.vertices).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(move_mesh(mesh, {}).vertices, mesh.vertices);
}

TEST(RandomMotion, TurnsAboutTheCentroidAndShiftsByTheDiagonal) {
  Mesh mesh = testing::bumpy_sphere(2, 3);
  mesh.vertices.rowwise() += Eigen::RowVector3d(100, -50, 3);
  const Eigen::Vector3d centroid = vertex_centroid(mesh);
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  Eigen::Vector3d mean_shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d mean_rotation = Eigen::Matrix3d::Zero();
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const RigidTransform motion = random_motion(mesh, seed);
    EXPECT_TRUE(is_rotation(motion.rotation, 1e-14));
    const Eigen::Vector3d shift = motion * centroid - centroid;
    EXPECT_NEAR(shift.norm(), diagonal, 1e-11);
    mean_shift += shift / diagonal / 500;
    mean_rotation += motion.rotation / 500;
  }
  // Each coordinate has mean 0 and variance 1/3: five standard errors are 0.13.
  EXPECT_LT(mean_shift.cwiseAbs().maxCoeff(), 0.13);
  EXPECT_LT(mean_rotation.cwiseAbs().maxCoeff(), 0.13);
}

TEST(RandomMotion, SeedDecides) {
  const Mesh mesh = testing::icosphere(1);
  EXPECT_EQ(random_motion(mesh, 1).rotation, random_motion(mesh, 1).rotation);
  EXPECT_EQ(random_motion(mesh, 1).translation, random_motion(mesh, 1).translation);
  EXPECT_NE(random_motion(mesh, 1).rotation, random_motion(mesh, 2).rotation);
}

TEST(NoiseDeviation, MeasuresBackWhatWasAdded) {
  const Mesh mesh = testing::icosphere(5);
  EXPECT_NEAR(noise_deviation(mesh, add_gaussian_noise(mesh, 0.02, 3)), 0.02, 0.02 * 0.02);
  EXPECT_EQ(noise_deviation(mesh, mesh), 0);
  EXPECT_THROW(noise_deviation(mesh, testing::icosphere(4)), InvalidInput);
  EXPECT_THROW(noise_deviation({Points(0, 3), {}}, {Points(0, 3), {}}), InvalidInput);
}

TEST(ThinMesh, KeepsThatManyVerticesInTheirOrder) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);  // 642 vertices
  for (const double share : {0.0, 0.1, 0.55, 0.9, 1.0}) {
    const Mesh thin = thin_mesh(mesh, share, 4);
    ASSERT_EQ(thin.vertices.rows(), std::lround(share * 642));
    Eigen::Index from = 0;
    for (Eigen::Index row = 0; row < thin.vertices.rows(); ++row, ++from) {
      while (from < 642 && mesh.vertices.row(from) != thin.vertices.row(row)) ++from;
      ASSERT_LT(from, 642) << "not a vertex of the mesh, or not in its order";
    }
    thin.validate("thin");
  }
  EXPECT_EQ(thin_mesh(mesh, 1, 4).triangles.rows(), mesh.triangles.rows());
  EXPECT_THROW(thin_mesh(mesh, 1.1, 4), InvalidInput);
  EXPECT_THROW(thin_mesh(mesh, -0.1, 4), InvalidInput);
  EXPECT_THROW(thin_mesh(mesh, std::nan(""), 4), InvalidInput);
}

TEST(ThinMesh, EveryVertexIsAsLikely) {
  Mesh mesh = testing::grid(10, 10);
  std::vector<int> kept(100);
  constexpr int kDraws = 2000;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const Points thin = thin_mesh({mesh.vertices, Triangles(0, 3)}, 0.3, seed).vertices;
    for (Eigen::Index row = 0; row < thin.rows(); ++row)
      ++kept[static_cast<std::size_t>(10 * thin(row, 1) + thin(row, 0))];
  }
  const double spread = std::sqrt(kDraws * 0.3 * 0.7);
  for (const int count : kept) EXPECT_NEAR(count, 0.3 * kDraws, 5 * spread);
  EXPECT_NE(thin_mesh(mesh, 0.5, 1).vertices, thin_mesh(mesh, 0.5, 2).vertices);
  EXPECT_EQ(thin_mesh(mesh, 0.5, 1).vertices, thin_mesh(mesh, 0.5, 1).vertices);
}

TEST(ThinMesh, WhatIsLeftOfTheTrianglesTellsTheOutside) {
  const Mesh mesh = testing::bumpy_sphere(4, 2);  // 2562 vertices around the origin
  for (const double share : {0.9, 0.5, 0.1}) {
    const Mesh thin = thin_mesh(mesh, share, 5);
    const Points normals = area_weighted_normals(thin);
    int outwards = 0;
    for (Eigen::Index row = 0; row < normals.rows(); ++row)
      outwards += normals.row(row).dot(thin.vertices.row(row)) > 0;
    EXPECT_GT(outwards, 0.99 * static_cast<double>(normals.rows())) << share;
    // A closed surface has twice as many triangles as vertices, less four.
    EXPECT_NEAR(static_cast<double>(thin.triangles.rows()), 2.0 * static_cast<double>(thin.vertices.rows()),
                0.05 * static_cast<double>(thin.vertices.rows()));
  }
}

TEST(ThinMesh, TrianglesFollowTheNearestKeptVertex) {
  // Of a strip of two rows, keeping all gives it back; a vertex without triangles keeps none.
  Mesh mesh = testing::grid(3, 2);
  EXPECT_EQ(thin_mesh(mesh, 1, 1).triangles.rows(), 4);
  mesh.triangles.resize(0, 3);
  EXPECT_EQ(thin_mesh(mesh, 1, 1).triangles.rows(), 0);
}

TEST(ThinMesh, LeavesOutTrianglesThatNoHalfEdgesCanTake) {
  // Three triangles on one edge: the third is none of a surface, and no edge leads to its last corner.
  Mesh mesh;
  mesh.vertices = Points::Random(6, 3);
  mesh.triangles.resize(3, 3);
  mesh.triangles << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  for (std::uint64_t seed = 0; seed < 200; ++seed) thin_mesh(mesh, 0.5, seed).validate("thin");
}

}  // namespace
}  // namespace corral
