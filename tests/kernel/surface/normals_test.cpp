// SPDX-License-Identifier: MIT
#include "kernel/surface/normals.h"

#include <gtest/gtest.h>

#include "kernel/error.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/surface.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

Points normals_of(const Mesh& mesh, int k = 20) { return estimate_normals(mesh, {k}); }

Mesh shifted(Mesh mesh, const Eigen::RowVector3d& offset) {
  mesh.vertices.rowwise() += offset;
  return mesh;
}

TEST(EstimateNormals, AgreeWithTheReference) {
  for (Mesh mesh : {testing::bumpy_sphere(3, 1), shifted(testing::bumpy_sphere(3, 2), {3, -4, 5})}) {
    for (const int k : {3, 6, 20, 50})
      EXPECT_LT((normals_of(mesh, k) - testing::reference_normals(mesh, k)).rowwise().norm().maxCoeff(), 1e-9) << k;
    mesh.triangles.resize(0, 3);
    EXPECT_LT((normals_of(mesh) - testing::reference_normals(mesh, 20)).rowwise().norm().maxCoeff(), 1e-9);
  }
}

TEST(EstimateNormals, PointOutOfASphereWhereverItLies) {
  for (const Eigen::RowVector3d& offset : {Eigen::RowVector3d(0, 0, 0), Eigen::RowVector3d(0, 0, 1000)}) {
    const Mesh mesh = shifted(testing::icosphere(3), offset);
    const Points normals = normals_of(mesh);
    for (int row = 0; row < normals.rows(); ++row)
      EXPECT_GT(normals.row(row).dot(mesh.vertices.row(row) - offset), 0.99);
  }
}

TEST(EstimateNormals, FollowTheWinding) {
  Mesh mesh = testing::icosphere(2);
  mesh.triangles.col(1).swap(mesh.triangles.col(2));
  const Points normals = normals_of(mesh);
  for (int row = 0; row < normals.rows(); ++row) EXPECT_LT(normals.row(row).dot(mesh.vertices.row(row)), -0.95);
}

TEST(EstimateNormals, PointAtTheOriginWithoutFaces) {
  Mesh around = testing::icosphere(3), beyond = shifted(testing::icosphere(3), {0, 0, 1000});
  around.triangles.resize(0, 3);
  beyond.triangles.resize(0, 3);
  const Points inward = normals_of(around), forward = normals_of(beyond);
  for (int row = 0; row < inward.rows(); ++row) {
    EXPECT_LT(inward.row(row).dot(around.vertices.row(row)), -0.99);
    EXPECT_LE(forward.row(row).dot(beyond.vertices.row(row)), 0);
  }
}

TEST(EstimateNormals, VertexWithoutFacesLooksAtTheOriginAmongOthersThatHaveThem) {
  Mesh mesh = testing::grid(8, 8);  // faces +z
  mesh.vertices.col(2).setConstant(5);
  mesh.vertices.conservativeResize(65, 3);
  mesh.vertices.row(64) << 3.5, 3.5, 5;
  const Points normals = normals_of(mesh);
  EXPECT_NEAR(normals(0, 2), 1, 1e-12);
  EXPECT_NEAR(normals(64, 2), -1, 1e-12);
}

TEST(EstimateNormals, OfAFlatGridAreExact) {
  const Points normals = normals_of(testing::grid(9, 6));
  EXPECT_LT((normals.rowwise() - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(EstimateNormals, OfATiltedPlaneAreExact) {
  const Mesh plane = testing::grid(12, 10, 0.1);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const RigidTransform motion = random_motion(plane, seed);
    const Eigen::RowVector3d expected = motion.rotation.col(2).transpose();
    EXPECT_LT((normals_of(move_mesh(plane, motion)).rowwise() - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(EstimateNormals, OfASymmetricPatchOfASphereAreRadial) {
  // The five or six around a vertex of the coarse icosahedron, and itself, lie symmetrically about its radius.
  const Mesh mesh = testing::icosphere(2);
  const Points normals = normals_of(mesh, 6);
  for (int row = 0; row < 12; ++row) EXPECT_NEAR(normals.row(row).dot(mesh.vertices.row(row)), 1, 1e-12);
}

TEST(EstimateNormals, OfACylinderAreRadial) {
  Mesh mesh{Points(40 * 12, 3), Triangles(0, 3)};
  for (int row = 0; row < mesh.vertices.rows(); ++row) {
    const double angle = 2 * std::acos(-1.0) * (row % 40) / 40;
    mesh.vertices.row(row) << 6 * std::cos(angle), 6 * std::sin(angle), row / 40;
  }
  const Points normals = normals_of(mesh, 9);
  for (int row = 0; row < normals.rows(); ++row) {
    if (row / 40 < 2 || row / 40 > 9) continue;  // around an end the nine nearest lie on one side
    const Eigen::RowVector3d radial(mesh.vertices(row, 0) / 6, mesh.vertices(row, 1) / 6, 0);
    EXPECT_LT((normals.row(row).cwiseAbs() - radial.cwiseAbs()).norm(), 1e-9) << row;
  }
}

TEST(EstimateNormals, FarFromTheOriginStaysAccurate) {
  const Mesh far = shifted(testing::bumpy_sphere(3, 3), {1e7, -1e7, 1e7});
  EXPECT_LT((normals_of(far) - testing::reference_normals(far, 20)).rowwise().norm().maxCoeff(), 1e-7);
}

TEST(EstimateNormals, MoveAlongWithTheMesh) {
  // The noise leaves no two vertices at the same distance from a third.
  const Mesh mesh = add_gaussian_noise(testing::bumpy_sphere(3, 4), 1e-3, 4);
  const RigidTransform motion = random_motion(mesh, 5);
  const Points expected = normals_of(mesh) * motion.rotation.transpose();
  EXPECT_LT((normals_of(move_mesh(mesh, motion)) - expected).rowwise().norm().maxCoeff(), 1e-9);
}

TEST(EstimateNormals, AreUnitOrZero) {
  Mesh line{Points::Zero(30, 3), Triangles(0, 3)};
  for (int row = 0; row < 30; ++row) line.vertices.row(row) = (row + 1) * Eigen::RowVector3d(0.3, -0.7, 0.2);
  EXPECT_TRUE(normals_of(line).isZero(0));
  const Mesh place{Points::Ones(100, 3), Triangles(0, 3)};
  EXPECT_TRUE(normals_of(place).isZero(0));
  const Mesh pair{points_of({{0, 0, 1}, {1, 0, 1}}), Triangles(0, 3)};
  EXPECT_TRUE(normals_of(pair).isZero(0));
  const Mesh three{points_of({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}), Triangles(0, 3)};
  EXPECT_LT((normals_of(three) - Eigen::RowVector3d(0, 0, -1).replicate(3, 1)).cwiseAbs().maxCoeff(), 1e-12);
  const Points normals = normals_of(testing::bumpy_sphere(3, 6));
  EXPECT_LT((normals.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
}

TEST(EstimateNormals, OfNoVerticesAreNone) { EXPECT_EQ(normals_of(Mesh{Points(0, 3), Triangles(0, 3)}).rows(), 0); }

TEST(EstimateNormals, NeedThreeNeighbours) {
  for (const int k : {2, 1, 0, -5}) EXPECT_THROW(normals_of(testing::icosphere(1), k), InvalidInput);
}

TEST(EstimateNormals, OfThreePointsAreTheirCrossProduct) {
  const Mesh mesh{points_of({{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}), Triangles(0, 3)};
  const Eigen::RowVector3d expected = -Eigen::RowVector3d(6, 3, 2).normalized();  // towards the origin
  EXPECT_LT((normals_of(mesh).rowwise() - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(EstimateNormals, AreZeroWithoutAPlane) {
  for (const Points& points : {points_of({{1, 2, 3}}), points_of({{1, 2, 3}, {2, 2, 3}}),
                               points_of({{1, 2, 3}, {2, 2, 3}, {4, 2, 3}}), Points(Points::Ones(40, 3))})
    EXPECT_TRUE(normals_of({points, Triangles(0, 3)}).isZero(0));
}

TEST(EstimateNormals, UnitOfLengthDoesNotMatter) {
  const Mesh mesh = testing::bumpy_sphere(3, 7);
  for (const double scale : {1e-6, 1e6})
    EXPECT_LT((normals_of({scale * mesh.vertices, mesh.triangles}) - normals_of(mesh)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(NormalGuide, AutoTakesTheNamedSensorThenWhatTheMeshHas) {
  Mesh mesh = testing::icosphere(1);
  mesh.normals = mesh.vertices;
  mesh.sensor = Eigen::Vector3d(0, 0, 9);
  NormalOptions options;
  EXPECT_EQ(normal_guide(mesh, options), NormalGuide::Faces);
  mesh.triangles.resize(0, 3);
  EXPECT_EQ(normal_guide(mesh, options), NormalGuide::Normals);
  mesh.normals.resize(0, 3);
  EXPECT_EQ(normal_guide(mesh, options), NormalGuide::OwnSensor);
  mesh.sensor.reset();
  EXPECT_EQ(normal_guide(mesh, options), NormalGuide::Origin);
  options.sensor = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(normal_guide(testing::icosphere(1), options), NormalGuide::NamedSensor);
  options.side = NormalSide::Mesh;
  EXPECT_EQ(normal_guide(testing::icosphere(1), options), NormalGuide::Faces);
  EXPECT_EQ(normal_guide(mesh, options), NormalGuide::NamedSensor);
  options.side = NormalSide::File;
  EXPECT_THROW(normal_guide(mesh, options), InvalidInput);
}

TEST(EstimateNormals, FollowTheNormalsOrTheSensorOfTheMesh) {
  Mesh cloud = testing::icosphere(3);
  const Points outward = normals_of(cloud);
  cloud.triangles.resize(0, 3);
  cloud.normals = -3 * cloud.vertices;  // of any length, inwards
  EXPECT_EQ(estimate_normals(cloud), -outward);
  cloud.normals.row(5).setZero();  // unknown there: towards the origin, which is inwards too
  EXPECT_EQ(estimate_normals(cloud), -outward);
  cloud.sensor = 50 * cloud.vertices.row(5).transpose();  // towards the sensor of the file, if that is known
  EXPECT_EQ(estimate_normals(cloud).row(5), outward.row(5));
  EXPECT_EQ(estimate_normals(cloud).row(6), -outward.row(6));
  cloud.normals.resize(0, 3);
  cloud.sensor = Eigen::Vector3d(0, 0, 50);
  NormalOptions options;
  options.sensor = cloud.sensor;
  options.side = NormalSide::Origin;
  EXPECT_EQ(estimate_normals(cloud), estimate_normals(cloud, options));
}

TEST(EstimateNormals, LookAtTheSensor) {
  Mesh mesh = testing::icosphere(3);
  NormalOptions options;
  options.sensor = Eigen::Vector3d(0, 0, 40);
  options.side = NormalSide::Mesh;
  const Points outward = estimate_normals(mesh, options);  // faces decide
  options.side = NormalSide::Origin;
  const Points turned = estimate_normals(mesh, options);
  mesh.triangles.resize(0, 3);
  options.side = NormalSide::Mesh;
  EXPECT_EQ(estimate_normals(mesh, options), turned);
  for (int row = 0; row < turned.rows(); ++row) {
    EXPECT_GT(outward.row(row).dot(mesh.vertices.row(row)), 0.99);
    EXPECT_GE(turned.row(row).dot(options.sensor->transpose() - mesh.vertices.row(row)), 0);
  }
  EXPECT_LT((turned - outward).rowwise().norm().maxCoeff(), 2.001);
  EXPECT_GT((turned - outward).rowwise().norm().maxCoeff(), 1.9) << "those on the far side are turned";
}

}  // namespace
}  // namespace corral
