// SPDX-License-Identifier: MIT
#include "apps/pair/surface_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/meshes.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::vector<std::string> warnings_of(const Mesh& mesh) { return surface_warnings(mesh, point_spacing(mesh.vertices)); }

Mesh with_vertex(Mesh mesh, const Eigen::RowVector3d& vertex) {
  mesh.vertices.conservativeResize(mesh.vertices.rows() + 1, 3);
  mesh.vertices.bottomRows(1) = vertex;
  return mesh;
}

TEST(SurfaceWarnings, NoneForCleanNoisyAndThinnedSurfaces) {
  const Mesh mesh = testing::bumpy_sphere(4, 1);
  EXPECT_THAT(warnings_of(mesh), IsEmpty());
  EXPECT_THAT(warnings_of(add_gaussian_noise(mesh, 0.02, 1)), IsEmpty());
  EXPECT_THAT(warnings_of(thin_mesh(mesh, 0.1, 1)), IsEmpty());
}

TEST(SurfaceWarnings, NamesTheStrayVertexAndTheRemedy) {
  const Mesh mesh = with_vertex(testing::bumpy_sphere(4, 1), {900, 0, 0});
  const int last = static_cast<int>(mesh.vertices.rows()) - 1;
  EXPECT_THAT(warnings_of(mesh), ElementsAre(AllOf(StartsWith("stray point: vertex " + std::to_string(last) + " lies "),
                                                   HasSubstr("--drop-stray"), HasSubstr("--resolution"))));
  EXPECT_THAT(warnings_of(with_vertex(mesh, {0, 2000, 0})),
              ElementsAre(StartsWith("stray points: vertex " + std::to_string(last) + " and 1 more lie up to ")));
}

TEST(SurfaceWarnings, AFarVertexThatHardlyMovesPrIsNotNamed) {
  const Mesh mesh = testing::bumpy_sphere(4, 1);
  const double pr = point_resolution(mesh.vertices);
  const Mesh far = with_vertex(mesh, {1 + 60 * pr, 0, 0});
  EXPECT_FALSE(point_spacing(far.vertices).strays.empty());
  EXPECT_THAT(warnings_of(far), IsEmpty());
}

TEST(SurfaceWarnings, UnevenDensityIsNotStrayPoints) {
  Mesh mesh = testing::bumpy_sphere(4, 1);  // and a box of large faces around, as in models by hand
  for (int i = 0; i < 60; ++i) mesh = with_vertex(mesh, {3.0 + i / 4, 1.0 * (i % 4), 2.0 * (i % 2)});
  EXPECT_THAT(warnings_of(mesh), IsEmpty());
}

TEST(SurfaceWarnings, NamesTheStepOf32BitCoordinatesFarFromTheOrigin) {
  Mesh mesh = testing::bumpy_sphere(4, 1);
  const Points moved = mesh.vertices.rowwise() + Eigen::RowVector3d(500000, 5600000, 200);
  mesh.vertices = moved.cast<float>().cast<double>();
  const std::vector<std::string> warnings = warnings_of(mesh);
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings.back(), AllOf(StartsWith("rounding: "), HasSubstr("in steps of 0.5 ("), HasSubstr("5.6e+06")));
  mesh.vertices = moved;  // in 64 bits nothing is lost
  EXPECT_THAT(warnings_of(mesh), IsEmpty());
}

TEST(UnitWarning, NamesPowersOfTenAndOtherFactorsOnBothSizes) {
  for (const double factor : {10.0, 0.1, 1000.0, 0.001, 2.0, 0.5, 25.4})
    EXPECT_THAT(unit_warning({100, 1}, {100 * factor, factor}), StartsWith("units may differ: the target's pr is "))
        << factor;
  EXPECT_THAT(unit_warning({100, 1}, {2000, 11}), StartsWith("units may differ")) << "in a scene of twice the size";
}

TEST(UnitWarning, NoneForSizesOfOneUnit) {
  EXPECT_EQ(unit_warning({100, 1}, {100, 1}), "");
  EXPECT_EQ(unit_warning({100, 1}, {140, 1.4}), "") << "a smaller part, or noise";
  EXPECT_EQ(unit_warning({100, 1}, {100, 3}), "") << "a thinned side";
  EXPECT_EQ(unit_warning({100, 1}, {800, 1}), "") << "clutter around";
  EXPECT_EQ(unit_warning({100, 1}, {400, 2}), "");
}

TEST(NormalHint, OnlyWhereOneSideIsToldAndTheOtherNot) {
  const NormalGuide told[] = {NormalGuide::Faces, NormalGuide::Normals, NormalGuide::OwnSensor};
  for (const NormalGuide guide : told) {
    EXPECT_THAT(normal_hint(guide, NormalGuide::Origin),
                HasSubstr("the normals of the target point towards the origin"));
    EXPECT_THAT(normal_hint(NormalGuide::Origin, guide),
                HasSubstr("the normals of the source point towards the origin"));
    EXPECT_EQ(normal_hint(guide, NormalGuide::Faces), "");
  }
  EXPECT_EQ(normal_hint(NormalGuide::Origin, NormalGuide::Origin), "");
}

TEST(WithoutVertices, RenumbersTheRestAndDropsTheirFaces) {
  Mesh mesh = testing::grid(3, 2);
  mesh.normals = mesh.vertices;
  const Mesh rest = without_vertices(mesh, {0, 4});
  EXPECT_EQ(rest.vertices.rows(), mesh.vertices.rows() - 2);
  EXPECT_EQ(rest.vertices.row(0), mesh.vertices.row(1));
  EXPECT_EQ(rest.vertices.row(3), mesh.vertices.row(5));
  EXPECT_EQ(rest.normals, rest.vertices);
  int kept = 0;
  for (int face = 0; face < mesh.triangles.rows(); ++face) {
    const auto corners = mesh.triangles.row(face).array();
    if ((corners == 0).any() || (corners == 4).any()) continue;
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_EQ(rest.vertices.row(rest.triangles(kept, corner)), mesh.vertices.row(mesh.triangles(face, corner)));
    ++kept;
  }
  EXPECT_EQ(rest.triangles.rows(), kept);
  EXPECT_LT(kept, mesh.triangles.rows());
}

}  // namespace
}  // namespace corral
