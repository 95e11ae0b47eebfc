// SPDX-License-Identifier: MIT
#include "kernel/surface/fpfh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kernel/error.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/fpfh.h"
#include "tests/support/renumbering.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::reference_fpfh;

constexpr FpfhForm kBoth[] = {FpfhForm::Paper, FpfhForm::Pcl};
constexpr int kTheta = 0, kAlpha = 11, kPhi = 22, kMiddle = 5;

struct Surface {
  Mesh mesh;
  Points normals;
  double resolution;
};

Surface surface_of(const Mesh& mesh) { return {mesh, estimate_normals(mesh), point_resolution(mesh.vertices)}; }

/// Noise, so that no two pairs are alike and none lies at the border of two bins.
Surface noisy_sphere(std::uint64_t seed, int levels = 3) {
  return surface_of(add_gaussian_noise(testing::bumpy_sphere(levels, seed), 0.004, seed));
}

Indices some_rows(const Points& points, int step) {
  Indices rows;
  for (int row = 0; row < points.rows(); row += step) rows.push_back(row);
  return rows;
}

Descriptors describe(const Surface& surface, const Indices& rows, const FpfhOptions& options = {},
                     const ParallelFor& parallel = one_by_one) {
  return describe_fpfh(surface.mesh.vertices, surface.normals, rows, surface.resolution, options, parallel);
}

void expect_identical(const Descriptors& found, const Descriptors& expected) {
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_TRUE(found.features == expected.features);
  EXPECT_EQ(found.dropped_small_support, expected.dropped_small_support);
  EXPECT_EQ(found.dropped_no_histogram, expected.dropped_no_histogram);
}

TEST(DescribeFpfh, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u})
    for (const FpfhForm form : kBoth)
      for (const double radius_pr : {2.5, 6.0}) {
        const Surface surface = noisy_sphere(seed);
        const Indices rows = some_rows(surface.mesh.vertices, 37);
        const Descriptors found = describe(surface, rows, {radius_pr, 4, form});
        ASSERT_EQ(found.vertices, rows);
        EXPECT_THAT(found.frames, IsEmpty());
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const auto expected =
              reference_fpfh(surface.mesh.vertices, surface.normals, rows[i], radius_pr * surface.resolution, form);
          EXPECT_LT((found.features.col(static_cast<Eigen::Index>(i)) - *expected).cwiseAbs().maxCoeff(), 1e-9)
              << rows[i];
        }
      }
}

TEST(DescribeFpfh, AgreesWithTheReferenceWhereNormalsAreInAnyDirection) {
  // All bins are reached, from both sides of every border.
  Surface surface{{testing::uniform_points(150, 3), Triangles(0, 3)}, testing::uniform_points(150, 4), 0.1};
  surface.normals.rowwise().normalize();
  Eigen::VectorXd total = Eigen::VectorXd::Zero(kFpfhSize);
  for (const FpfhForm form : kBoth) {
    const Indices rows = some_rows(surface.mesh.vertices, 11);
    const Descriptors found = describe(surface, rows, {8, 4, form});
    ASSERT_EQ(found.vertices, rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Eigen::VectorXd column = found.features.col(static_cast<Eigen::Index>(i));
      const auto expected = reference_fpfh(surface.mesh.vertices, surface.normals, rows[i], 0.8, form);
      EXPECT_LT((column - *expected).cwiseAbs().maxCoeff(), 1e-9) << rows[i];
      for (const int first : {kTheta, kAlpha, kPhi}) EXPECT_NEAR(column.segment(first, 11).sum(), 100, 1e-9);
      total += column;
    }
  }
  EXPECT_GT(total.minCoeff(), 0);
}

/// Two vertices; the histogram of the first has the one pair in it.
void expect_bins(const Eigen::Vector3d& normal, const Eigen::Vector3d& other, const std::array<int, 3>& bins) {
  const Points points = testing::points_of({{0, 0, 0}, {1, 0, 0}});
  Points normals(2, 3);
  normals << normal.transpose(), other.transpose();
  const Descriptors found = describe_fpfh(points, normals, {0, 1}, 1, {2, 1});
  for (int column = 0; column < 2; ++column) {
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(kFpfhSize);
    for (int i = 0; i < 3; ++i) expected(11 * i + bins[static_cast<std::size_t>(i)]) = 100;
    EXPECT_TRUE(found.features.col(column) == expected) << found.features.col(column).transpose();
  }
}

Eigen::Vector3d turned(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& vector) {
  return Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180, axis) * vector;
}

TEST(DescribeFpfh, OnePairLiesInTheBinsOfItsAngles) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  expect_bins(z, z, {5, 5, 5});
  // u = z and t - s = x: v = x cross z = -y, w = z cross -y = x. The other normal turns in the plane of v and u ...
  expect_bins(z, turned(30, x, z), {5, 5 + 3, 5});  // alpha = sin 30 degrees = 0.5 lies in 5/11 .. 7/11
  expect_bins(z, turned(-30, x, z), {5, 5 - 3, 5});
  // ... and in the plane of w and u, where it comes nearer to the line, and is the source from then on: phi is the cosine
  // of its angle to the line from it, -x.
  expect_bins(z, turned(30, y, z), {6, 5, 5 - 3});
  expect_bins(z, turned(-30, y, z), {4, 5, 5 + 3});
  // The opposite normal, half a turn away.
  expect_bins(z, turned(179, y, z), {0, 5, 5});
  expect_bins(z, turned(-179, y, z), {10, 5, 5});
}

TEST(DescribeFpfh, APlaneIsInTheMiddleBins) {
  for (const bool moved : {false, true})
    for (const FpfhForm form : kBoth) {
      Mesh mesh = testing::grid(15, 12);
      if (moved) mesh = move_mesh(mesh, random_motion(mesh, 1));
      const Descriptors found = describe(surface_of(mesh), {0, 70, 179}, {3, 3, form});
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(kFpfhSize);
      for (const int first : {kTheta, kAlpha, kPhi}) expected(first + kMiddle) = 100;
      ASSERT_EQ(found.features.cols(), 3);
      EXPECT_LT((found.features.colwise() - expected).cwiseAbs().maxCoeff(), 1e-12);
    }
}

TEST(DescribeFpfh, ASphereHasNoAlphaAndOneSidedAngles) {
  const Mesh sphere = testing::icosphere(3);
  const double radius =
      0.9;  // the angle between normals is at most 2 asin(0.45) = 53 degrees: theta bins 5 .. 6 or 5 .. 7
  const Descriptors found = describe_fpfh(sphere.vertices, sphere.vertices, {0, 17, 300}, 1, {radius});
  for (int column = 0; column < 3; ++column) {
    const Eigen::VectorXd feature = found.features.col(column);
    EXPECT_NEAR(feature(kAlpha + kMiddle), 100, 1e-9);
    EXPECT_NEAR(feature.segment(kTheta + 5, 3).sum(), 100, 1e-9);
    EXPECT_GT(feature(kTheta + 6), 20);
    EXPECT_NEAR(feature.segment(kPhi + 3, 3).sum(), 100, 1e-9);  // -0.45 .. 0: below the tangent plane
    EXPECT_GT(feature(kPhi + 4), 20);
  }
}

TEST(DescribeFpfh, RigidMotionDoesNotChangeIt) {
  for (const FpfhForm form : kBoth) {
    const Surface surface = noisy_sphere(5, 4);
    const RigidTransform motion = random_motion(surface.mesh, 6);
    const Surface moved{move_mesh(surface.mesh, motion), surface.normals * motion.rotation.transpose(),
                        surface.resolution};
    const Indices rows = some_rows(surface.mesh.vertices, 97);
    const Descriptors here = describe(surface, rows, {8, 10, form}), there = describe(moved, rows, {8, 10, form});
    ASSERT_EQ(here.vertices, there.vertices);
    EXPECT_LT((here.features - there.features).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(DescribeFpfh, ScaleByAPowerOfTwoIsExact) {
  Surface surface = noisy_sphere(7);
  const Indices rows = some_rows(surface.mesh.vertices, 13);
  for (const FpfhForm form : kBoth) {
    const Descriptors expected = describe(surface, rows, {6, 10, form});
    Surface large = surface;
    large.mesh.vertices *= 1024, large.resolution *= 1024;
    expect_identical(describe(large, rows, {6, 10, form}), expected);
  }
}

TEST(DescribeFpfh, SameBitsHoweverItRuns) {
  const Surface surface = noisy_sphere(8);
  const Indices rows = some_rows(surface.mesh.vertices, 5);
  const Indices old_row = testing::shuffled_rows(surface.mesh.vertices.rows(), 9),
                new_row = testing::inverse_of(old_row);
  const Surface other{testing::renumbered(surface.mesh, old_row), surface.normals(old_row, Eigen::all),
                      surface.resolution};
  for (const FpfhForm form : kBoth) {
    const FpfhOptions options{6, 10, form};
    const Descriptors expected = describe(surface, rows, options);
    expect_identical(describe(surface, rows, options, testing::last_first), expected);
    expect_identical(describe(surface, rows, options, testing::on_three_threads), expected);
    for (const std::int64_t target : testing::available_targets()) {
      const testing::ForcedTarget forced(target);
      expect_identical(describe(surface, rows, options), expected);
    }
    Indices renamed;
    for (const int row : rows) renamed.push_back(new_row[static_cast<std::size_t>(row)]);
    EXPECT_TRUE(describe(other, renamed, options).features == expected.features);
  }
}

TEST(DescribeFpfh, NormalsThatAreNoneTakeNoPart) {
  Surface surface = noisy_sphere(10);
  const Indices rows = some_rows(surface.mesh.vertices, 29);
  const double nan = std::nan("");
  for (const FpfhForm form : kBoth) {
    Surface zero = surface, not_finite = surface;
    for (int row = 0; row < surface.normals.rows(); row += 3) {
      zero.normals.row(row).setZero();
      not_finite.normals.row(row) << (row % 2 ? nan : 0.5), 0.1, (row % 2 ? 0 : HUGE_VAL);
    }
    const Descriptors found = describe(zero, rows, {6, 10, form});
    expect_identical(describe(not_finite, rows, {6, 10, form}), found);
    ASSERT_EQ(found.vertices, rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto expected = reference_fpfh(zero.mesh.vertices, zero.normals, rows[i], 6 * surface.resolution, form);
      EXPECT_LT((found.features.col(static_cast<Eigen::Index>(i)) - *expected).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(DescribeFpfh, PairsAlongANormalAreLeftOutOrInTheMiddle) {
  // The third vertex stands on the normal of the first, the second beside it.
  const Points points = testing::points_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  const Points normals = testing::points_of({{0, 0, 1}, {0, 1, 0}, {0, 0, 1}});
  for (const FpfhForm form : kBoth) {
    const Eigen::VectorXd found = describe_fpfh(points, normals, {0}, 1, {1.2, 1, form}).features.col(0);
    const auto expected = reference_fpfh(points, normals, 0, 1.2, form);
    EXPECT_LT((found - *expected).cwiseAbs().maxCoeff(), 1e-9);
    // The first and second have one pair: u = z, v = -y, alpha = -1, theta = 0. In the third, there is none, but for PCL.
    EXPECT_NEAR(found(kAlpha), form == FpfhForm::Paper ? 100 : 50, 1e-9);
  }
}

TEST(DescribeFpfh, TheRimIsInsideButForPcl) {
  const Points points = testing::points_of({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, 0, 0}});
  const Points normals = Eigen::RowVector3d(0, 0, 1).replicate(5, 1);
  for (const FpfhForm form : kBoth)
    for (int minimum = 0; minimum < 5; ++minimum) {
      const Descriptors found = describe_fpfh(points, normals, {0}, 1, {2, minimum, form});
      const int support = form == FpfhForm::Paper ? 3 : 1;  // the last vertex is a copy of the first
      EXPECT_EQ(found.vertices.size(), minimum <= support) << minimum;
      EXPECT_EQ(found.dropped_small_support, minimum > support);
    }
}

TEST(DescribeFpfh, CountsWhatItDrops) {
  // Row 0 is alone; the normals around row 1 are zero; the others stay.
  const Surface sphere = noisy_sphere(11);
  const Eigen::Index count = sphere.mesh.vertices.rows();
  const Points vertices = testing::stacked({testing::points_of({{500, 0, 0}}), sphere.mesh.vertices,
                                            sphere.mesh.vertices.rowwise() + Eigen::RowVector3d(0, 100, 0)});
  const Points normals = testing::stacked({testing::points_of({{0, 0, 1}}), Points::Zero(count, 3), sphere.normals});
  const auto second = static_cast<int>(1 + count);
  const Indices rows{second + 5, 0, 1, second, second + 5};
  for (const int minimum : {0, 10}) {
    const Descriptors found = describe_fpfh(vertices, normals, rows, 0.1, {6, minimum});
    EXPECT_THAT(found.vertices, ElementsAre(second + 5, second, second + 5));
    EXPECT_EQ(found.dropped_small_support, minimum > 0);
    EXPECT_EQ(found.dropped_no_frame, 0);
    EXPECT_EQ(found.dropped_no_histogram, minimum > 0 ? 1 : 2);
    ASSERT_EQ(found.features.cols(), 3);
    EXPECT_TRUE(found.features.col(0) == found.features.col(2));
  }
  const Descriptors none = describe_fpfh(vertices, normals, {}, 0.1);
  EXPECT_THAT(none.vertices, IsEmpty());
  EXPECT_EQ(none.features.rows(), kFpfhSize);
  EXPECT_EQ(none.features.cols(), 0);
  EXPECT_EQ(describe_fpfh(Points(0, 3), Points(0, 3), {}, 1).features.cols(), 0);
}

TEST(DescribeFpfh, InputAndOptionsAreChecked) {
  const Points vertices = testing::icosphere(2).vertices;
  EXPECT_NO_THROW(describe_fpfh(vertices, vertices, {0, 161}, 0.1));
  EXPECT_THROW(describe_fpfh(vertices, vertices.topRows(161), {0}, 0.1), InvalidInput);
  EXPECT_THROW(describe_fpfh(vertices, vertices, {0, 162}, 0.1), InvalidInput);
  EXPECT_THROW(describe_fpfh(vertices, vertices, {-1}, 0.1), InvalidInput);
  const auto refusal = [&](double resolution, const FpfhOptions& options) {
    return testing::refusal_of([&] { describe_fpfh(vertices, vertices, {0}, resolution, options); });
  };
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THAT(refusal(bad, {}), HasSubstr("resolution"));
    EXPECT_THAT(refusal(1, {bad}), HasSubstr("radius_pr"));
  }
  EXPECT_THAT(refusal(1, {15, -1}), HasSubstr("minimum_support"));
}

}  // namespace
}  // namespace corral
