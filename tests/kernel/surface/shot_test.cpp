// SPDX-License-Identifier: MIT
#include "kernel/surface/shot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/error.h"
#include "kernel/surface/harris.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/shot.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::support_of;

Eigen::Vector3d vertex_of(const Mesh& mesh, int row) { return mesh.vertices.row(row).transpose(); }

Indices some_rows(const Mesh& mesh, int step) {
  Indices rows;
  for (int row = 0; row < mesh.vertices.rows(); row += step) rows.push_back(row);
  return rows;
}

Descriptors describe(const Mesh& mesh, const Indices& rows, double resolution, const ShotOptions& options = {}) {
  return describe_shot(mesh.vertices, estimate_normals(mesh), rows, resolution, options);
}

TEST(DescribeShot, PutsFramesAndHistogramsTogether) {
  const Mesh mesh = testing::bumpy_sphere(4, 6);
  const Points normals = estimate_normals(mesh);
  const double resolution = point_resolution(mesh.vertices);
  const Indices rows{900, 3, 77, 3};
  const Descriptors found = describe(mesh, rows, resolution, {10});
  EXPECT_EQ(found.vertices, rows);
  ASSERT_EQ(found.features.cols(), 4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3d point = vertex_of(mesh, rows[i]);
    EXPECT_LT((found.frames[i] - *testing::reference_shot_frame(mesh.vertices, point, 10 * resolution)).norm(), 1e-9);
    EXPECT_LT((found.features.col(static_cast<Eigen::Index>(i)) -
               *testing::reference_shot_histogram(mesh.vertices, normals, point, found.frames[i], 10 * resolution))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9);
  }
}

TEST(DescribeShot, RigidMotionDoesNotChangeTheHistograms) {
  const Mesh mesh = testing::bumpy_sphere(4, 7);
  const double resolution = point_resolution(mesh.vertices);
  const RigidTransform motion = random_motion(mesh, 8);
  const Indices rows = some_rows(mesh, 23);
  const Descriptors here = describe(mesh, rows, resolution),
                    there = describe(move_mesh(mesh, motion), rows, resolution);
  ASSERT_EQ(here.vertices, there.vertices);
  EXPECT_LT((here.features - there.features).cwiseAbs().maxCoeff(), 1e-9);
  for (std::size_t i = 0; i < here.frames.size(); ++i)
    EXPECT_LT((here.frames[i] * motion.rotation.transpose() - there.frames[i]).norm(), 1e-9);
}

TEST(DescribeShot, CountsWhatItDrops) {
  // Row 0 is alone; the normals around row 1 are zero (no histogram); the others stay.
  Mesh mesh{Points(0, 3), Triangles(0, 3)};
  const Points sphere = testing::bumpy_sphere(3, 9).vertices;
  mesh.vertices.resize(1 + 2 * sphere.rows(), 3);
  mesh.vertices << 500, 0, 0, sphere, sphere.rowwise() + Eigen::RowVector3d(0, 100, 0);
  Points normals = estimate_normals(mesh);
  normals.middleRows(1, sphere.rows()).setZero();
  const int second = 1 + static_cast<int>(sphere.rows());
  for (const int minimum : {0, 10}) {
    const Descriptors found = describe_shot(mesh.vertices, normals, {0, 1, second, second + 5}, 0.1, {4, minimum});
    EXPECT_THAT(found.vertices, ElementsAre(second, second + 5));
    EXPECT_EQ(found.dropped_small_support, minimum > 0);
    EXPECT_EQ(found.dropped_no_frame, minimum == 0);
    EXPECT_EQ(found.dropped_no_histogram, 1);
    EXPECT_EQ(found.features.cols(), 2);
    EXPECT_EQ(found.frames.size(), 2u);
  }
  const Descriptors none = describe(mesh, {}, 1);
  EXPECT_THAT(none.vertices, IsEmpty());
  EXPECT_EQ(none.features.cols(), 0);
}

TEST(DescribeShot, SupportIsCountedWithoutTheKeypoint) {
  Mesh mesh = testing::bumpy_sphere(3, 5);
  const auto count = static_cast<int>(mesh.vertices.rows());
  mesh.vertices.conservativeResize(count + 3, 3);  // copies of a keypoint are no support of it
  for (int copy = 0; copy < 3; ++copy) mesh.vertices.row(count + copy) = mesh.vertices.row(40);
  const double resolution = point_resolution(mesh.vertices);
  const Indices rows = some_rows(mesh, 20);
  for (int minimum = 0; minimum < 40; ++minimum) {
    Indices expected;
    for (const int row : rows)
      if (support_of(mesh.vertices, mesh.vertices, vertex_of(mesh, row), 3 * resolution).count >= std::max(minimum, 5))
        expected.push_back(row);
    const Descriptors found = describe(mesh, rows, resolution, {3, minimum});
    EXPECT_EQ(found.vertices, expected) << minimum;
    EXPECT_EQ(found.vertices.size() + static_cast<std::size_t>(found.dropped_small_support + found.dropped_no_frame),
              rows.size());
  }
}

TEST(DescribeShot, WhatPadsTheGridIsNoSupport) {
  Mesh mesh = testing::bumpy_sphere(3, 5);  // its highest vertex, the last of the grid, next to the origin
  Eigen::Index last = 0;
  mesh.vertices.col(2).maxCoeff(&last);
  mesh.vertices.rowwise() -= Eigen::RowVector3d(mesh.vertices.row(last) + Eigen::RowVector3d(0, 0, 1e-3));
  ASSERT_NE(mesh.vertices.rows() % kLanes, 0);
  const double resolution = point_resolution(mesh.vertices);
  const auto row = static_cast<int>(last);
  const int count = support_of(mesh.vertices, mesh.vertices, vertex_of(mesh, row), 3 * resolution).count;
  EXPECT_EQ(describe(mesh, {row}, resolution, {3, count}).vertices.size(), 1u);
  EXPECT_EQ(describe(mesh, {row}, resolution, {3, count + 1}).vertices.size(), 0u);
}

TEST(DescribeShot, TheRimIsInsideButForPcl) {
  // Twelve vertices near the first, and twelve exactly at the radius.
  const Points near = 0.5 * testing::icosphere(0).vertices;
  Points vertices(25, 3);
  vertices.setZero();
  vertices.middleRows(1, 12) = near;
  for (int row = 13; row < 25; ++row) vertices(row, row % 3) = row % 2 == 0 ? 2 : -2;
  const Points normals = Eigen::RowVector3d(0, 0, 1).replicate(25, 1);
  for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product}) {
    EXPECT_EQ(describe_shot(vertices, normals, {0}, 1, {2, 24, form}).vertices.size(), form != ShotForm::PclBug)
        << choice_text(form);
    EXPECT_EQ(describe_shot(vertices, normals, {0}, 1, {2, 12, form}).vertices.size(), 1u) << choice_text(form);
    EXPECT_EQ(describe_shot(vertices, normals, {0}, 1, {2, 25, form}).vertices.size(), 0u) << choice_text(form);
  }
}

TEST(DescribeShot, EveryFormAgreesWithTheReference) {
  const Mesh mesh = testing::bumpy_sphere(4, 10);
  const Points normals = estimate_normals(mesh);
  const double resolution = point_resolution(mesh.vertices);
  const Indices rows = some_rows(mesh, 61);
  for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product}) {
    const Descriptors found = describe_shot(mesh.vertices, normals, rows, resolution, {15, 10, form});
    ASSERT_EQ(found.vertices, rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto expected = testing::reference_shot_histogram(mesh.vertices, normals, vertex_of(mesh, rows[i]),
                                                              found.frames[i], 15 * resolution, form);
      EXPECT_LT((found.features.col(static_cast<Eigen::Index>(i)) - *expected).cwiseAbs().maxCoeff(), 1e-9)
          << choice_text(form);
    }
  }
}

TEST(DescribeShot, NormalsAndKeypointsMustBelongToTheVertices) {
  const Points vertices = testing::icosphere(2).vertices;
  EXPECT_NO_THROW(describe_shot(vertices, vertices, {0, 161}, 0.1));
  EXPECT_THROW(describe_shot(vertices, vertices.topRows(161), {0}, 0.1), InvalidInput);
  EXPECT_THROW(describe_shot(vertices, vertices, {0, 162}, 0.1), InvalidInput);
  EXPECT_THROW(describe_shot(vertices, vertices, {-1}, 0.1), InvalidInput);
}

TEST(AddShotFrames, AreThoseOfTheDescriptor) {
  const Mesh mesh = testing::bumpy_sphere(4, 1);
  const double resolution = point_resolution(mesh.vertices);
  const Indices rows = detect_harris(mesh.vertices, resolution).vertices;
  const Descriptors expected = describe(mesh, rows, resolution);
  ASSERT_EQ(expected.vertices, rows);
  Descriptors found;
  found.vertices = rows;
  found.features = Eigen::MatrixXd::Random(5, static_cast<Eigen::Index>(rows.size()));
  const Eigen::MatrixXd features = found.features;
  add_shot_frames(mesh.vertices, resolution, {}, found);
  EXPECT_EQ(found.vertices, rows);
  EXPECT_TRUE(found.frames == expected.frames);
  EXPECT_EQ(found.features, features);
}

TEST(AddShotFrames, AKeypointWithoutAFrameIsDropped) {
  Mesh mesh = testing::bumpy_sphere(3, 1);
  mesh.vertices.conservativeResize(mesh.vertices.rows() + 1, Eigen::NoChange);
  const auto alone = static_cast<int>(mesh.vertices.rows()) - 1;
  mesh.vertices.row(alone).setConstant(100);
  Descriptors found;
  found.vertices = {3, alone, 5};
  found.features = Eigen::MatrixXd::Identity(3, 3);
  add_shot_frames(mesh.vertices, 0.1, {}, found);
  EXPECT_EQ(found.vertices, (Indices{3, 5}));
  EXPECT_EQ(found.frames.size(), 2u);
  EXPECT_EQ(found.dropped_no_frame, 1);
  EXPECT_EQ(found.features.col(1), Eigen::Vector3d::UnitZ());
  found.vertices = {0, alone + 1};
  EXPECT_THROW(add_shot_frames(mesh.vertices, 0.1, {}, found), InvalidInput);
}

TEST(DescribeShot, OptionsAreChecked) {
  const Mesh mesh = testing::icosphere(1);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(describe(mesh, {0}, bad), InvalidInput);
    EXPECT_THROW(describe(mesh, {0}, 1, {bad}), InvalidInput);
  }
  EXPECT_THROW(describe(mesh, {0}, 1, {15, -1}), InvalidInput);
  for (const char* bad : {"", "Additive", "shot", "pcl"})
    EXPECT_THROW(parse_options<ShotOptions>({{"form", bad}}, "shot"), InvalidInput);
  EXPECT_EQ(parse_options<ShotOptions>({{"form", "pcl-bug"}}, "shot").form, ShotForm::PclBug);
}

}  // namespace
}  // namespace corral
