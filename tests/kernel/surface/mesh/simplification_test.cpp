// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/simplification.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

#include "kernel/error.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using testing::grid;
using testing::icosphere;

Eigen::RowVector3d face_normal(const Mesh& mesh, Eigen::Index face) {
  const Eigen::RowVector3d a = mesh.vertices.row(mesh.triangles(face, 0));
  const Eigen::RowVector3d b = mesh.vertices.row(mesh.triangles(face, 1));
  const Eigen::RowVector3d c = mesh.vertices.row(mesh.triangles(face, 2));
  return (b - a).cross(c - a);
}

TEST(SimplifyForDisplay, ASphereStaysASphere) {
  const SimplifiedMesh coarse = simplify_for_display(icosphere(6), 1000);  // of 40,962 vertices
  const Mesh& mesh = coarse.mesh;
  mesh.validate("coarse");
  EXPECT_LE(mesh.vertices.rows(), 1000);
  EXPECT_GT(mesh.vertices.rows(), 700);  // as fine as it may be
  ASSERT_EQ(coarse.normals.rows(), mesh.vertices.rows());
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row) {
    EXPECT_NEAR(mesh.vertices.row(row).norm(), 1, 0.01);
    EXPECT_NEAR(coarse.normals.row(row).norm(), 1, 1e-12);
    EXPECT_GT(coarse.normals.row(row).dot(mesh.vertices.row(row)), 0.98);
  }
  double area = 0;
  std::set<std::array<int, 3>> seen;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face) {
    area += face_normal(mesh, face).norm() / 2;
    EXPECT_GE(face_normal(mesh, face).dot(mesh.vertices.row(mesh.triangles(face, 0))), 0);  // outwards
    std::array<int, 3> corners{mesh.triangles(face, 0), mesh.triangles(face, 1), mesh.triangles(face, 2)};
    std::sort(corners.begin(), corners.end());
    EXPECT_LT(corners[0], corners[1]);
    EXPECT_LT(corners[1], corners[2]);
    EXPECT_TRUE(seen.insert(corners).second);
  }
  EXPECT_NEAR(area, 4 * 3.14159, 0.4);  // nothing is lost but what a coarse sphere must lose
}

TEST(SimplifyForDisplay, ASmallMeshKeepsItsVertices) {
  const Mesh sphere = icosphere(2);
  const SimplifiedMesh same = simplify_for_display(sphere, static_cast<int>(sphere.vertices.rows()));
  EXPECT_EQ(same.mesh.vertices, sphere.vertices);
  EXPECT_EQ(same.mesh.triangles, sphere.triangles);
  const SimplifiedMesh fewer = simplify_for_display(sphere, static_cast<int>(sphere.vertices.rows()) - 1);
  EXPECT_LT(fewer.mesh.vertices.rows(), sphere.vertices.rows());
}

TEST(SimplifyForDisplay, WhereTwoSidesMeetTheNormalsAreThoseOfTheCoarseMesh) {
  Mesh sheet = grid(20, 20);
  const Eigen::Index faces = sheet.triangles.rows();
  Triangles both(2 * faces, 3);
  both.topRows(faces) = sheet.triangles;
  both.bottomRows(faces) << sheet.triangles.col(0), sheet.triangles.col(2), sheet.triangles.col(1);
  sheet.triangles = both;
  const SimplifiedMesh coarse = simplify_for_display(sheet, 50);
  for (Eigen::Index row = 0; row < coarse.normals.rows(); ++row) EXPECT_NEAR(coarse.normals.row(row).norm(), 1, 1e-12);
}

TEST(SimplifyForDisplay, ACloudStaysACloud) {
  Mesh cloud = icosphere(4);
  cloud.triangles.resize(0, 3);
  const SimplifiedMesh coarse = simplify_for_display(cloud, 100);
  EXPECT_LE(coarse.mesh.vertices.rows(), 100);
  EXPECT_GT(coarse.mesh.vertices.rows(), 50);
  EXPECT_EQ(coarse.mesh.triangles.rows(), 0);
  EXPECT_EQ(coarse.normals.rows(), 0);
}

TEST(SimplifyForDisplay, EndsForPointsInOnePlaceOrOnALine) {
  Mesh cloud;
  cloud.vertices = Points::Constant(10, 3, 2.5);
  EXPECT_EQ(simplify_for_display(cloud, 3).mesh.vertices.rows(), 1);
  for (int row = 0; row < 10; ++row) cloud.vertices(row, 0) = row;
  const Mesh coarse = simplify_for_display(cloud, 3).mesh;
  EXPECT_LE(coarse.vertices.rows(), 3);
  EXPECT_EQ(simplify_for_display({}, 3).mesh.vertices.rows(), 0);
  EXPECT_EQ(simplify_for_display(cloud, 1).mesh.vertices.rows(), 1);
  EXPECT_EQ(simplify_for_display(cloud, 1).mesh.vertices(0, 0), 4.5);
}

TEST(SimplifyForDisplay, RefusesNoVerticesAtAll) {
  EXPECT_THROW(simplify_for_display(icosphere(1), 0), InvalidInput);
  Mesh broken = icosphere(1);
  broken.triangles(0, 0) = 1000;
  EXPECT_THROW(simplify_for_display(broken, 10), InvalidInput);
}

}  // namespace
}  // namespace corral
