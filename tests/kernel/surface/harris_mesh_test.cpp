// SPDX-License-Identifier: MIT
#include "kernel/surface/harris_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/harris_mesh_cases.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/harris_mesh.h"
#include "tests/support/renumbering.h"

namespace corral {
namespace {

using testing::count_absent;
using testing::expect_close;
using testing::expect_identical;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kNeighborhoods;
using testing::kSelections;
using testing::noisy_grid;
using testing::options_of;
using testing::renumbered;
using testing::shuffled_rows;

TEST(HarrisMesh, AgreesWithTheReference) {
  int found_by_all = 0;
  for (const Mesh& mesh : {testing::bumpy_sphere(4, 1), testing::bumpy_sphere(4, 2), noisy_grid(8)}) {
    const double resolution = point_resolution(mesh.vertices);
    for (const MeshNeighborhood neighborhood : kNeighborhoods)
      for (const MeshSelection selection : kSelections) {
        const HarrisMeshOptions options = options_of(neighborhood, selection);
        const Keypoints found = detect_harris_mesh(mesh, resolution, options);
        const Keypoints expected = testing::reference_harris_mesh(mesh, resolution, options);
        EXPECT_EQ(found.vertices, expected.vertices) << choice_text(neighborhood) << " " << choice_text(selection);
        EXPECT_EQ(found.candidates, expected.candidates);
        EXPECT_LT(static_cast<int>(found.vertices.size()), found.candidates);
        found_by_all += static_cast<int>(found.vertices.size());
      }
  }
  EXPECT_GT(found_by_all, 18 * 10);
}

TEST(HarrisMesh, ScaleByAPowerOfTwoChangesNotOneBit) {
  const Mesh mesh = testing::bumpy_sphere(4, 10);
  const double resolution = point_resolution(mesh.vertices);
  for (const double scale : {1024.0, 1 / 1048576.0})
    for (const MeshNeighborhood neighborhood : kNeighborhoods)
      for (const MeshSelection selection : kSelections) {
        const HarrisMeshOptions options = options_of(neighborhood, selection);
        const Mesh scaled{mesh.vertices * scale, mesh.triangles};
        expect_identical(harris_mesh_response(scaled, resolution * scale, options),
                         harris_mesh_response(mesh, resolution, options));
        EXPECT_EQ(detect_harris_mesh(scaled, resolution * scale, options).vertices,
                  detect_harris_mesh(mesh, resolution, options).vertices);
      }
}

TEST(HarrisMesh, RigidMotionAndAnyScaleChangeNothing) {
  for (const std::uint64_t seed : {11u, 12u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    Mesh moved = move_mesh(mesh, random_motion(mesh, seed));
    const double resolution = point_resolution(mesh.vertices);
    for (const MeshNeighborhood neighborhood : kNeighborhoods) {
      HarrisMeshOptions options = options_of(neighborhood);
      // The box of a turned mesh is another one: the same length along the edges is another share of it.
      const double extent = options.extent * bounding_box(mesh.vertices).diagonal();
      const Eigen::VectorXd expected = harris_mesh_response(mesh, resolution, options);
      const Keypoints keypoints = detect_harris_mesh(mesh, resolution, options);
      options.extent = extent / bounding_box(moved.vertices).diagonal();
      expect_close(harris_mesh_response(moved, resolution, options), expected);
      EXPECT_EQ(detect_harris_mesh(moved, resolution, options).vertices, keypoints.vertices);
      const Mesh scaled{moved.vertices * 0.0037, moved.triangles};
      expect_close(harris_mesh_response(scaled, resolution * 0.0037, options), expected);
    }
  }
}

TEST(HarrisMesh, RenumberedVerticesGiveTheSameKeypointsToTheLastBit) {
  for (const Mesh& mesh : {testing::bumpy_sphere(4, 13), noisy_grid(14)}) {
    const double resolution = point_resolution(mesh.vertices);
    const Indices old_row = shuffled_rows(mesh.vertices.rows(), 15);
    Mesh other = renumbered(mesh, old_row);
    other.triangles = other.triangles(shuffled_rows(mesh.triangles.rows(), 16), Eigen::all).eval();
    for (const MeshNeighborhood neighborhood : kNeighborhoods)
      for (const MeshSelection selection : kSelections) {
        const HarrisMeshOptions options = options_of(neighborhood, selection);
        const Eigen::VectorXd expected = harris_mesh_response(mesh, resolution, options);
        expect_identical(harris_mesh_response(other, resolution, options), expected(old_row));
        Indices found;
        for (const int row : detect_harris_mesh(other, resolution, options).vertices)
          found.push_back(old_row[static_cast<std::size_t>(row)]);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, detect_harris_mesh(mesh, resolution, options).vertices);
      }
  }
}

TEST(HarrisMesh, OddMeshesGoThrough) {
  RandomStream random(17);
  for (int trial = 0; trial < 60; ++trial) {
    Mesh mesh{Points::Zero(14, 3), Triangles(30, 3)};
    for (int row = 0; row < 12; ++row)  // some places twice
      mesh.vertices.row(row) = row % 4 == 3 ? mesh.vertices.row(row - 1).eval() : random.direction().transpose().eval();
    for (int& corner : mesh.triangles.reshaped()) corner = static_cast<int>(random.below(12));
    for (const MeshNeighborhood neighborhood : kNeighborhoods)
      for (const MeshSelection selection : kSelections) {
        HarrisMeshOptions options = options_of(neighborhood, selection);
        options.radius_pr = 1.5;
        options.fraction = 1;
        const Keypoints keypoints = detect_harris_mesh(mesh, 1, options);
        EXPECT_TRUE(std::is_sorted(keypoints.vertices.begin(), keypoints.vertices.end()));
        EXPECT_LE(static_cast<int>(keypoints.vertices.size()), keypoints.candidates);
        const Eigen::VectorXd response = harris_mesh_response(mesh, 1, options);
        EXPECT_TRUE(std::isnan(response(12)) && std::isnan(response(13))) << "vertices without triangles";
      }
  }
}

TEST(HarrisMesh, WhatJoinsNothingChangesNothing) {
  // Vertices without triangles, exact copies, triangles without area, a triangle three of which share an edge.
  const Mesh mesh = testing::bumpy_sphere(3, 18);
  const Eigen::Index count = mesh.vertices.rows(), faces = mesh.triangles.rows();
  Mesh odd = mesh;
  odd.vertices.conservativeResize(count + 3, 3);
  odd.vertices.bottomRows(3) << mesh.vertices.row(5), mesh.vertices.row(5), Eigen::RowVector3d::Zero();
  odd.triangles.conservativeResize(faces + 4, 3);
  odd.triangles.bottomRows(4) << 9, 9, 200, 5, static_cast<int>(count), 77, 5, static_cast<int>(count),
      static_cast<int>(count) + 1, mesh.triangles(0, 0), mesh.triangles(0, 1), 300;
  const HarrisMeshOptions options = options_of(MeshNeighborhood::Rings);
  const Eigen::VectorXd response = harris_mesh_response(odd, 1, options);
  expect_identical(response.head(count), harris_mesh_response(mesh, 1, options));
  EXPECT_EQ(count_absent(response), 3);
}

TEST(HarrisMesh, OfNothingButDegenerateFacesThereIsNone) {
  Mesh mesh{Points::Ones(50, 3), Triangles::Zero(10, 3)};
  for (const MeshNeighborhood neighborhood : kNeighborhoods) {
    EXPECT_EQ(count_absent(harris_mesh_response(mesh, 1, options_of(neighborhood))), 50);
    EXPECT_THAT(detect_harris_mesh(mesh, 1, options_of(neighborhood, MeshSelection::Clustering)).vertices, IsEmpty());
  }
}

TEST(HarrisMesh, APointCloudIsRefusedInOneSentence) {
  for (const Eigen::Index vertices : {0, 40}) {
    try {
      detect_harris_mesh({Points::Ones(vertices, 3), Triangles(0, 3)}, 1);
      ADD_FAILURE() << "accepted";
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("harris-mesh needs the faces of a mesh"));
      EXPECT_THAT(error.what(), HasSubstr("the default detector"));
    }
  }
}

template <class Change>
void expect_refused(Change&& change) {
  HarrisMeshOptions options;
  change(options);
  EXPECT_THROW(detect_harris_mesh(testing::icosphere(1), 1, options), InvalidInput);
  EXPECT_THROW(harris_mesh_response(testing::icosphere(1), 1, options), InvalidInput);
  EXPECT_THROW(select_harris_mesh(testing::icosphere(1), Eigen::VectorXd::Ones(42), options), InvalidInput);
}

TEST(HarrisMesh, OptionsAreChecked) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    expect_refused([&](HarrisMeshOptions& options) { options.radius_pr = bad; });
    expect_refused([&](HarrisMeshOptions& options) { options.extent = bad; });
    expect_refused([&](HarrisMeshOptions& options) { options.separation = bad; });
    expect_refused([&](HarrisMeshOptions& options) { options.fraction = bad; });
    EXPECT_THROW(harris_mesh_response(testing::icosphere(1), bad), InvalidInput);
    EXPECT_THROW(detect_harris_mesh(testing::icosphere(1), bad), InvalidInput);
  }
  expect_refused([](HarrisMeshOptions& options) { options.fraction = 1.01; });
  expect_refused([](HarrisMeshOptions& options) { options.rings = 0; });
  for (const double bad : {-0.01, 0.25, std::nan("")})
    expect_refused([&](HarrisMeshOptions& options) { options.k = bad; });
}

TEST(HarrisMesh, AMeshThatIsNotValidIsRefused) {
  Mesh mesh = testing::icosphere(1);
  EXPECT_THROW(select_harris_mesh(mesh, Eigen::VectorXd::Ones(41)), InvalidInput);
  mesh.vertices(3, 1) = std::nan("");
  EXPECT_THROW(detect_harris_mesh(mesh, 1), InvalidInput);
  mesh = testing::icosphere(1);
  mesh.triangles(5, 2) = 42;
  EXPECT_THROW(detect_harris_mesh(mesh, 1), InvalidInput);
}

TEST(HarrisMesh, ANeighborhoodOfTheWholeMeshIsRefused) {
  const Mesh mesh = testing::icosphere(4);
  HarrisMeshOptions options;
  options.extent = 2;
  EXPECT_THROW(detect_harris_mesh(mesh, 1, options), InvalidInput);
  // Of a small one it may be.
  EXPECT_NO_THROW(detect_harris_mesh(testing::icosphere(2), 1, options));
}

}  // namespace
}  // namespace corral
