// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/error.h"
#include "kernel/surface/harris.h"
#include "kernel/surface/mesh/topology.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "kernel/surface/shot.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::points_of;
using testing::refusal_of;

/// All steps from a mesh to its descriptors.
Descriptors describe(const Mesh& mesh, double resolution) {
  return describe_shot(mesh.vertices, estimate_normals(mesh), detect_harris(mesh.vertices, resolution).vertices,
                       resolution);
}

TEST(Mesh, RoughSurfacesGoThroughEveryStep) {
  // Duplicate and isolated vertices, triangles without area, one given twice, a third one on an edge, two parts.
  const Mesh sphere = testing::bumpy_sphere(3, 2);
  const auto count = static_cast<int>(sphere.vertices.rows());
  Mesh rough;
  rough.vertices.resize(2 * count + 3, 3);
  rough.vertices << sphere.vertices, sphere.vertices.rowwise() + Eigen::RowVector3d(4, 0, 0), sphere.vertices.row(7),
      sphere.vertices.row(7), Eigen::RowVector3d(0, 0, 9);
  rough.triangles.resize(2 * sphere.triangles.rows() + 4, 3);
  rough.triangles << sphere.triangles, sphere.triangles.array() + count, Eigen::RowVector3i(5, 5, 6),
      Eigen::RowVector3i(7, 2 * count, 9), sphere.triangles.row(0),
      Eigen::RowVector3i(sphere.triangles(3, 0), sphere.triangles(3, 1), count + 1);
  for (const double offset : {0.0, 1e7}) {
    Mesh mesh = rough;
    mesh.vertices.array() += offset;
    EXPECT_NO_THROW(mesh.validate("test"));
    const Topology topology = inspect_topology(mesh);
    EXPECT_EQ(topology.duplicate_vertices, 2);
    EXPECT_EQ(topology.isolated_vertices, 2);
    EXPECT_EQ(topology.degenerate_faces, 2);
    EXPECT_EQ(topology.non_manifold_edges, 4);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.boundary_edges, 2);
    const Descriptors found = describe(mesh, point_resolution(mesh.vertices));
    EXPECT_GT(found.features.cols(), 5);
    EXPECT_TRUE(found.features.allFinite());
  }
}

TEST(Mesh, ValidMeshesPass) {
  EXPECT_NO_THROW(testing::icosphere(2).validate("test"));
  EXPECT_NO_THROW((Mesh{Points(0, 3), Triangles(0, 3)}.validate("test")));
  EXPECT_NO_THROW((Mesh{Points::Ones(3, 3), Triangles(0, 3)}.validate("test")));
}

TEST(Mesh, CoordinateThatIsNotFiniteIsRefused) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (const int axis : {0, 1, 2}) {
      Mesh mesh = testing::icosphere(1);
      mesh.vertices(17, axis) = bad;
      EXPECT_THAT(refusal_of([&] { mesh.validate("test"); }), HasSubstr("test"));
    }
}

TEST(Mesh, CornerThatIsNotThereIsRefused) {
  for (const int bad : {-1, 42, 2147483647, -2147483647 - 1})
    for (const int corner : {0, 1, 2}) {
      Mesh mesh = testing::icosphere(1);  // 42 vertices
      mesh.triangles(5, corner) = bad;
      EXPECT_THROW(mesh.validate("test"), InvalidInput) << bad;
    }
  Mesh mesh = testing::icosphere(1);
  mesh.triangles(5, 0) = 41;
  EXPECT_NO_THROW(mesh.validate("test"));
  mesh.vertices.resize(0, 3);
  EXPECT_THROW(mesh.validate("test"), InvalidInput);
}

TEST(VertexCentroid, IsTheMeanOfAllVertices) {
  const Mesh mesh{points_of({{0, 0, 0}, {3, 0, 0}, {0, 6, -3}}), Triangles(0, 3)};
  EXPECT_LT((vertex_centroid(mesh) - Eigen::Vector3d(1, 2, -1)).norm(), 1e-15);
  EXPECT_EQ(vertex_centroid({Points(0, 3), Triangles(0, 3)}), Eigen::Vector3d(Eigen::Vector3d::Zero()));
  EXPECT_LT(vertex_centroid(testing::icosphere(3)).norm(), 1e-14);
}

TEST(AreaWeightedNormals, OfAGridAreAreas) {
  // Spacing 2: every triangle has area 2; 6 triangles inside, 3 along a side, 1 or 2 at a corner.
  const Points normals = area_weighted_normals(testing::grid(5, 4, 2.0));
  EXPECT_TRUE(normals.leftCols(2).isZero(0));
  EXPECT_DOUBLE_EQ(normals(6, 2), 12);
  EXPECT_DOUBLE_EQ(normals(2, 2), 6);
  EXPECT_DOUBLE_EQ(normals(0, 2), 4);
  EXPECT_DOUBLE_EQ(normals(4, 2), 2);
}

TEST(AreaWeightedNormals, WeighLargeTrianglesMore) {
  Mesh mesh{points_of({{0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {0, 0, 1}}), Triangles(2, 3)};
  mesh.triangles << 0, 1, 2, 0, 2, 3;  // area 4 along +z, area 1 along +x
  const Points normals = area_weighted_normals(mesh);
  EXPECT_EQ(normals.row(0), Eigen::RowVector3d(1, 0, 4));
  EXPECT_EQ(normals.row(1), Eigen::RowVector3d(0, 0, 4));
  EXPECT_EQ(normals.row(3), Eigen::RowVector3d(1, 0, 0));
}

TEST(AreaWeightedNormals, OfAClosedSurfaceAddUpToNothing) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  EXPECT_LT(area_weighted_normals(mesh).colwise().sum().norm(), 1e-13);
  const Points outward = area_weighted_normals(testing::icosphere(3));
  EXPECT_GT(outward.cwiseProduct(testing::icosphere(3).vertices).rowwise().sum().minCoeff(), 0);
}

TEST(AreaWeightedNormals, AreZeroWithoutTriangles) {
  Mesh mesh{Points::Random(4, 3), Triangles(1, 3)};
  mesh.triangles << 0, 1, 2;
  EXPECT_EQ(area_weighted_normals(mesh).row(3), Eigen::RowVector3d(0, 0, 0));
  mesh.triangles << 0, 1, 1;
  EXPECT_TRUE(area_weighted_normals(mesh).isZero(0));
  EXPECT_TRUE(area_weighted_normals({Points::Random(4, 3), Triangles(0, 3)}).isZero(0));
  EXPECT_EQ(area_weighted_normals({Points(0, 3), Triangles(0, 3)}).rows(), 0);
}

TEST(AreaWeightedNormals, SurviveAnOffset) {
  Mesh mesh = testing::icosphere(2);
  const Points near = area_weighted_normals(mesh);
  mesh.vertices.array() += 1e7;
  EXPECT_LT((area_weighted_normals(mesh) - near).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace corral
