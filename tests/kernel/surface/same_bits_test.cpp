// SPDX-License-Identifier: MIT
// What no result of the surface room may depend on: the vector registers, the threads, the numbers of the vertices; and
// under a rigid motion it moves along.
#include <gtest/gtest.h>

#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/renumbering.h"
#include "tests/support/surface_stages.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::ForcedLevel;
using testing::run_stages;
using testing::SurfaceStages;

/// Some without faces, with duplicates, in two parts of which one is far away.
std::vector<Mesh> some_meshes() {
  const Mesh noisy = add_gaussian_noise(testing::bumpy_sphere(4, 1), 0.004, 1);
  Mesh cloud = noisy, doubled = noisy;
  cloud.triangles.resize(0, 3);
  doubled.vertices.conservativeResize(noisy.vertices.rows() + 300, 3);
  doubled.vertices.bottomRows(300) = noisy.vertices.topRows(300);
  const Mesh parts{testing::stacked({noisy.vertices, 1e4 + testing::bumpy_sphere(3, 2).vertices.array()}),
                   noisy.triangles};
  return {noisy, cloud, doubled, parts, testing::bumpy_sphere(4, 3)};
}

TEST(SameBits, AtEveryVectorLevel) {
  for (const Mesh& mesh : some_meshes())
    for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product}) {
      const SurfaceStages expected = run_stages(mesh, one_by_one, form);
      EXPECT_GT(expected.descriptors.vertices.size(), 20u);
      for (const VectorLevel level : testing::available_levels()) {
        const ForcedLevel forced(level);
        expect_identical(run_stages(mesh, one_by_one, form), expected);
      }
    }
}

TEST(SameBits, InAnyOrderAndOnAnyThreads) {
  for (const Mesh& mesh : some_meshes()) {
    const SurfaceStages expected = run_stages(mesh);
    expect_identical(run_stages(mesh, testing::last_first), expected);
    expect_identical(run_stages(mesh, testing::on_three_threads), expected);
  }
}

/// Clusters so crowded, or so far apart, that the cells give up on them.
Mesh crowded(int in_crowd, int elsewhere) {
  return {testing::stacked({1e-7 * testing::uniform_points(in_crowd, 5), testing::uniform_points(elsewhere, 6),
                            testing::points_of({{900, 0, 0}, {0, -40, 1}})}),
          Triangles(0, 3)};
}

TEST(SameBits, WhereTheCellsGiveUp) {
  for (const Mesh& mesh : {crowded(4500, 600), crowded(6000, 900)}) {
    const Points normals = estimate_normals(mesh);
    const double resolution = point_resolution(mesh.vertices);
    for (const VectorLevel level : testing::available_levels()) {
      const ForcedLevel forced(level);
      EXPECT_TRUE(estimate_normals(mesh) == normals);
      EXPECT_EQ(point_resolution(mesh.vertices), resolution);
    }
    EXPECT_TRUE(estimate_normals(mesh, {}, testing::on_three_threads) == normals);
    EXPECT_EQ(point_resolution(mesh.vertices, testing::on_three_threads), resolution);
    const Indices old_row = testing::shuffled_rows(mesh.vertices.rows(), 7);
    const Mesh other = testing::renumbered(mesh, old_row);
    EXPECT_TRUE(estimate_normals(other) == normals(old_row, Eigen::all));
    EXPECT_EQ(point_resolution(other.vertices), resolution);
  }
}

TEST(SameBits, MatchesOnAnyThreadsAndAtEveryLevel) {
  const Mesh mesh = testing::bumpy_sphere(4, 4);
  const Eigen::MatrixXd source = run_stages(mesh).descriptors.features;
  const Eigen::MatrixXd target = run_stages(add_gaussian_noise(mesh, 0.002, 5)).descriptors.features;
  ASSERT_GT(source.cols(), 20);
  for (const bool mutual : {false, true}) {
    const MatchingOptions options{Matcher::Exact, mutual};
    const FeatureMatches expected = match_features(source, target, options);
    const auto expect_same = [&](const FeatureMatches& found) {
      EXPECT_EQ(found.source, expected.source);
      EXPECT_EQ(found.nearest, expected.nearest);
      EXPECT_TRUE(found.distance == expected.distance && found.second_distance == expected.second_distance);
    };
    expect_same(match_features(source, target, options, testing::last_first));
    expect_same(match_features(source, target, options, testing::on_three_threads));
    for (const VectorLevel level : testing::available_levels()) {
      const ForcedLevel forced(level);
      expect_same(match_features(source, target, options));
    }
  }
}

/// The stages of a renumbered mesh under the old numbers.
SurfaceStages under_old_numbers(SurfaceStages stages, const Indices& old_row) {
  const Indices new_row = testing::inverse_of(old_row);
  stages.normals = stages.normals(new_row, Eigen::all).eval();
  stages.response = stages.response(new_row).eval();
  stages.keypoints.vertices = testing::by_old_name(stages.keypoints.vertices, old_row);
  const Descriptors found = stages.descriptors;
  stages.descriptors.vertices = testing::by_old_name(found.vertices, old_row);
  for (std::size_t i = 0; i < found.vertices.size(); ++i) {
    const int old = old_row[static_cast<std::size_t>(found.vertices[i])];
    const auto& names = stages.descriptors.vertices;
    const auto place = std::lower_bound(names.begin(), names.end(), old) - names.begin();
    stages.descriptors.frames[static_cast<std::size_t>(place)] = found.frames[i];
    stages.descriptors.features.col(place) = found.features.col(static_cast<Eigen::Index>(i));
  }
  return stages;
}

// Faces stay in their order: their normals are added in it. No two vertices are equals, among which the
// lower number would win.
TEST(SameBits, HoweverTheVerticesAreNumbered) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Mesh mesh = add_gaussian_noise(testing::bumpy_sphere(4, seed), 0.003, seed);
    const Mesh parts{testing::stacked({mesh.vertices, 3 + 2 * testing::bumpy_sphere(4, seed + 5).vertices.array()}),
                     mesh.triangles};
    for (const Mesh& surface : {mesh, parts}) {
      const Indices old_row = testing::shuffled_rows(surface.vertices.rows(), 10 + seed);
      const SurfaceStages expected = run_stages(surface);
      EXPECT_GT(expected.descriptors.vertices.size(), 20u);
      expect_identical(under_old_numbers(run_stages(testing::renumbered(surface, old_row)), old_row), expected);
    }
  }
}

TEST(SameBits, EvenWhereFacesAreShuffledTooTheNormalsAgree) {
  const Mesh mesh = add_gaussian_noise(testing::bumpy_sphere(4, 4), 0.003, 4);
  Mesh other = mesh;
  other.triangles = mesh.triangles(testing::shuffled_rows(mesh.triangles.rows(), 9), Eigen::all).eval();
  // Sums of face normals choose a side, and do no more.
  EXPECT_TRUE(estimate_normals(other) == estimate_normals(mesh));
}

TEST(RigidMotion, CarriesEveryStageAlong) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Mesh mesh = add_gaussian_noise(testing::bumpy_sphere(4, seed), 0.003, seed);
    const RigidTransform motion = random_motion(mesh, seed);
    const SurfaceStages here = run_stages(mesh), there = run_stages(move_mesh(mesh, motion));
    EXPECT_NEAR(there.resolution, here.resolution, 1e-9 * here.resolution);
    EXPECT_LT((there.normals - here.normals * motion.rotation.transpose()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((there.response - here.response).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(there.keypoints.vertices, here.keypoints.vertices);
    ASSERT_EQ(there.descriptors.vertices, here.descriptors.vertices);
    EXPECT_LT((there.descriptors.features - here.descriptors.features).cwiseAbs().maxCoeff(), 1e-9);
    for (std::size_t i = 0; i < here.descriptors.frames.size(); ++i)
      EXPECT_LT((there.descriptors.frames[i] - here.descriptors.frames[i] * motion.rotation.transpose())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-9);
  }
}

}  // namespace
}  // namespace corral
