// SPDX-License-Identifier: MIT
#include "kernel/surface/search/coincidence.h"

#include <gtest/gtest.h>

#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

Coincidence of(const Points& points, const Points& surface, const RigidTransform& motion, double resolution) {
  return coincidence(points, surface, PointTree(surface), motion, resolution);
}

TEST(Coincidence, MeasuresTheShareAndTheMedianDistance) {
  const Points surface = testing::grid(20, 20).vertices;
  const RigidTransform up{Eigen::Matrix3d::Identity(), {0, 0, 0.5}};
  const Coincidence near = of(surface, surface, up, 1);
  EXPECT_EQ(near.share, 1);
  EXPECT_DOUBLE_EQ(near.median_pr.value(), 0.5);
  EXPECT_TRUE(near.is_good());
  EXPECT_DOUBLE_EQ(of(surface, surface, up, 0.25).median_pr.value(), 2) << "the limit is inclusive";
  EXPECT_FALSE(of(surface, surface, up, 0.25).is_good());
  EXPECT_FALSE(of(surface, surface, up, 0.2).median_pr);
  EXPECT_FALSE(of(surface, surface, up, 0.2).is_good());
  const RigidTransform aside{Eigen::Matrix3d::Identity(), {15, 0, 0}};
  EXPECT_DOUBLE_EQ(of(surface, surface, aside, 1).share, 7.0 / 20) << "5 columns meet, 2 more are within 2 pr";
}

TEST(Coincidence, SurfacesThatCrossAreNotOne) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const double resolution = point_resolution(mesh.vertices);
  RandomStream random(4);
  int good = 0;
  for (int i = 0; i < 20; ++i) {
    const RigidTransform wrong{random.rotation(), Eigen::Vector3d(0.5 + random.uniform(), 0, 0)};
    good += of(mesh.vertices, mesh.vertices, wrong, resolution).is_good();
  }
  EXPECT_EQ(good, 0);
}

TEST(Coincidence, CountsThePointsWithinFourPrToo) {
  const Points surface = testing::grid(20, 20).vertices;
  const RigidTransform up{Eigen::Matrix3d::Identity(), {0, 0, 3}};
  const Coincidence found = of(surface, surface, up, 1);
  EXPECT_EQ(found.share, 0);
  EXPECT_FALSE(found.median_pr);
  EXPECT_EQ(found.near_share, 1);
  EXPECT_LT((found.middle - (up * Eigen::Vector3d(surface.colwise().mean().transpose()))).norm(), 1e-12);
}

TEST(Distinctness, IsLargeWhereTheSurfacesAreOneAndAboutOneWhereTheyCross) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const double resolution = point_resolution(mesh.vertices);
  const PointTree tree(mesh.vertices);
  const auto distinct = [&](const RigidTransform& motion) {
    return distinctness(coincidence(mesh.vertices, mesh.vertices, tree, motion, resolution), mesh.vertices, tree,
                        motion, resolution);
  };
  const Points flat = testing::grid(40, 40).vertices;
  const PointTree flat_tree(flat);
  EXPECT_GT(distinctness(coincidence(flat, flat, flat_tree, {}, 1), flat, flat_tree, {}, 1), 1.5);
  RandomStream random(4);
  for (int i = 0; i < 10; ++i) EXPECT_LT(distinct({random.rotation(), Eigen::Vector3d(0.8, 0, 0)}), 1.2) << i;
}

TEST(OpposedShare, IsZeroForOneSideAndOneForTheOther) {
  const Points flat = testing::grid(20, 20).vertices;
  Points up = Points::Zero(flat.rows(), 3);
  up.col(2).setOnes();
  const Points down = -up;
  const PointTree tree(flat);
  const RigidTransform near{Eigen::Matrix3d::Identity(), {0, 0, 0.5}}, away{Eigen::Matrix3d::Identity(), {0, 0, 9}};
  EXPECT_EQ(opposed_share({flat, up}, {flat, up}, tree, near, 1), 0);
  EXPECT_EQ(opposed_share({flat, up}, {flat, down}, tree, near, 1), 1);
  EXPECT_FALSE(opposed_share({flat, up}, {flat, up}, tree, away, 1));
  Eigen::Matrix3d over = Eigen::Vector3d(1, -1, -1).asDiagonal();  // turned over about x, and its normals with it
  EXPECT_EQ(opposed_share({flat, up}, {flat, down}, tree, {over, Eigen::Vector3d(0, 19, 0)}, 1), 0);
}

TEST(Coincidence, NoiseAndAThinnedSideLeaveItGood) {
  const Mesh mesh = testing::bumpy_sphere(4, 3);
  const double resolution = point_resolution(mesh.vertices);
  EXPECT_TRUE(of(mesh.vertices, add_gaussian_noise(mesh, 0.7 * resolution, 1).vertices, {}, resolution).is_good());
  EXPECT_TRUE(of(thin_mesh(mesh, 0.1, 1).vertices, mesh.vertices, {}, resolution).is_good());
}

}  // namespace
}  // namespace corral
