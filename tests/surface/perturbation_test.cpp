// SPDX-License-Identifier: MIT
#include "kernel/surface/perturbation.h"

#include <gtest/gtest.h>

#include <cmath>

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
  const double diagonal = bounding_box_diagonal(mesh.vertices);
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

}  // namespace
}  // namespace corral
