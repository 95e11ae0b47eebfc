// SPDX-License-Identifier: MIT
#include "kernel/surface/iss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/error.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/execution.h"
#include "tests/support/meshes.h"
#include "tests/support/point_sets.h"
#include "tests/support/reference/iss.h"
#include "tests/support/renumbering.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::reference_iss;
using testing::reference_iss_saliency;

constexpr IssWeights kBoth[] = {IssWeights::Density, IssWeights::None};

IssOptions with(IssWeights weights) {
  IssOptions options;
  options.weights = weights;
  return options;
}

Mesh cloud(const Points& points) { return {points, Triangles(0, 3)}; }

/// A bumpy sphere with its upper half denser than the lower one, and some noise: no two neighbourhoods are alike.
Mesh uneven(std::uint64_t seed) {
  const Mesh coarse = testing::bumpy_sphere(3, seed), fine = testing::bumpy_sphere(4, seed);
  std::vector<int> lower, upper;
  for (int row = 0; row < coarse.vertices.rows(); ++row)
    if (coarse.vertices(row, 2) < 0) lower.push_back(row);
  for (int row = 0; row < fine.vertices.rows(); ++row)
    if (fine.vertices(row, 2) >= 0) upper.push_back(row);
  return add_gaussian_noise(
      cloud(testing::stacked({coarse.vertices(lower, Eigen::all), fine.vertices(upper, Eigen::all)})), 0.003, seed);
}

TEST(IssSaliency, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u})
    for (const IssWeights weights : kBoth) {
      const Mesh mesh = uneven(seed);
      const double resolution = point_resolution(mesh.vertices);
      const Eigen::VectorXd found = iss_saliency(mesh, resolution, with(weights)),
                            expected = reference_iss_saliency(mesh.vertices, resolution, with(weights));
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.maxCoeff());
      EXPECT_GT((expected.array() > 0).count(), mesh.vertices.rows() / 2);
    }
}

TEST(DetectIss, AgreesWithTheReferenceForEveryOption) {
  std::vector<IssOptions> all(8);
  all[1].salient_radius_pr = 3, all[1].non_max_radius_pr = 7;
  all[2].density_radius_pr = 9;
  all[3].gamma_21 = 0.6;
  all[4].gamma_32 = 0.1;
  all[5].minimum_neighbors = 40;
  all[6].weights = IssWeights::None;
  all[7].weights = IssWeights::None, all[7].non_max_radius_pr = 2, all[7].minimum_neighbors = 12;
  std::vector<Indices> found;
  const Mesh mesh = uneven(3);
  const double resolution = point_resolution(mesh.vertices);
  for (const IssOptions& options : all) {
    const Keypoints keypoints = detect_iss(mesh, resolution, options),
                    expected = reference_iss(mesh.vertices, resolution, options);
    EXPECT_EQ(keypoints.vertices, expected.vertices);
    EXPECT_EQ(keypoints.candidates, expected.candidates);
    EXPECT_GT(keypoints.vertices.size(), 3u);
    for (const Indices& other : found) EXPECT_NE(keypoints.vertices, other) << "an option without effect";
    found.push_back(keypoints.vertices);
  }
}

TEST(DetectIss, VerticesExactlyAtARadiusAreOutside) {
  // In a lattice many vertices lie exactly as far from each other as the radii.
  Points lattice(6 * 6 * 6, 3);
  for (int row = 0; row < lattice.rows(); ++row) lattice.row(row) << row % 6, row / 6 % 6, row / 36;
  lattice.col(1) *= 1.25, lattice.col(2) *= 1.5;
  for (const double radius : {1.0, 1.25, 1.5, 2.0, 3.0, 5.0})
    for (const IssWeights weights : kBoth) {
      IssOptions options{radius, radius, radius, 0.975, 0.975, 2, weights};
      const Keypoints found = detect_iss(cloud(lattice), 1, options), expected = reference_iss(lattice, 1, options);
      const Eigen::VectorXd difference =
          iss_saliency(cloud(lattice), 1, options) - reference_iss_saliency(lattice, 1, options);
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << radius;
      EXPECT_EQ(found.candidates > 0, expected.candidates > 0);
    }
}

TEST(DetectIss, FlatGroundHasNone) {
  const Mesh flat = testing::grid(20, 23);
  const Mesh turned = move_mesh(flat, random_motion(flat, 1));
  for (const IssWeights weights : kBoth) {
    EXPECT_THAT(detect_iss(flat, 1, with(weights)).vertices, IsEmpty());
    EXPECT_THAT(detect_iss(turned, 1, with(weights)).vertices, IsEmpty());
    EXPECT_EQ(iss_saliency(turned, 1, with(weights)).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(IssSaliency, IsTheSmallestEigenvalueOnAnAxisCross) {
  // Points on the axes at 3, 2 and 1: the scatter is diagonal.
  const Points cross =
      testing::points_of({{0, 0, 0}, {3, 0, 0}, {-3, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 1}, {0, 0, -1}});
  IssOptions options{4, 1, 0.5, 0.975, 0.975, 1, IssWeights::None};
  EXPECT_DOUBLE_EQ(iss_saliency(cloud(cross), 1, options)(0), 2);
  options.weights = IssWeights::Density;
  EXPECT_DOUBLE_EQ(iss_saliency(cloud(cross), 1, options)(0), 2.0 / 7);
  options.density_radius_pr = 1.5;  // the middle sees the two at 1, and they see it: weights 1/3 and 1/2
  EXPECT_DOUBLE_EQ(iss_saliency(cloud(cross), 1, options)(0), 1 / (1.0 / 3 + 4 + 1));
  options.gamma_21 = 4.0 / 9;  // e2 / e1 is as large
  options.weights = IssWeights::None;
  EXPECT_EQ(iss_saliency(cloud(cross), 1, options)(0), 0);
  options.gamma_21 = 0.45;
  EXPECT_DOUBLE_EQ(iss_saliency(cloud(cross), 1, options)(0), 2);
  options.gamma_32 = 0.25;
  EXPECT_EQ(iss_saliency(cloud(cross), 1, options)(0), 0);
}

TEST(DetectIss, TheTopOfAPyramidIsTheOnlyKeypoint) {
  Points pyramid(15 * 15, 3);
  for (int row = 0; row < pyramid.rows(); ++row) {
    const int x = row % 15 - 7, y = row / 15 - 7;
    pyramid.row(row) << x, 0.9 * y, 0.8 * (7 - std::max(std::abs(x), std::abs(y)));
  }
  for (const IssWeights weights : kBoth)
    EXPECT_THAT(detect_iss(cloud(pyramid), 1, {4, 4, 2, 0.975, 0.975, 5, weights}).vertices, ElementsAre(7 * 15 + 7));
}

TEST(DetectIss, AKeypointOfABoxIsNearItsCorner) {
  // Three faces of different size, so that the eigenvalues at the corner differ.
  std::vector<testing::Row3> rows{{0, 0, 0}};
  for (int a = 0; a <= 12; ++a)
    for (int b = 0; b <= 12; ++b) {
      if (a + b > 0) rows.push_back({1.0 * a, 0.8 * b, 0});
      if (a > 0) rows.push_back({0, 0.8 * b, 0.6 * a});
      if (a > 0 && b > 0) rows.push_back({1.0 * b, 0, 0.6 * a});
    }
  for (const IssWeights weights : kBoth) {
    const Points box = testing::points_of(rows);
    IssOptions options{4, 4, 2, 0.975, 0.975, 5, weights};
    const Eigen::VectorXd saliency = iss_saliency(cloud(box), 1, options);
    int far_from_edges = 0;
    for (int row = 0; row < box.rows(); ++row)
      if ((box.row(row).array() >= 4).count() == 2 && box.row(row).minCoeff() == 0) {
        EXPECT_EQ(saliency(row), 0);
        ++far_from_edges;
      }
    EXPECT_GT(far_from_edges, 50);
    const Keypoints found = detect_iss(cloud(box), 1, options);
    const bool near_the_corner =
        std::any_of(found.vertices.begin(), found.vertices.end(), [&](int row) { return box.row(row).norm() < 3; });
    EXPECT_TRUE(near_the_corner);
  }
}

TEST(DetectIss, EqualSaliencyGoesToTheLowerIndex) {
  Mesh mesh = uneven(6);  // every vertex twice
  const Eigen::Index count = mesh.vertices.rows();
  const double resolution = point_resolution(mesh.vertices);
  const Indices single = detect_iss(mesh, resolution).vertices;
  mesh.vertices = mesh.vertices.replicate(2, 1).eval();
  const Keypoints doubled = detect_iss(mesh, resolution);
  EXPECT_EQ(doubled.vertices, single);
  EXPECT_LT(doubled.vertices.back(), count);
}

TEST(DetectIss, MotionKeepsTheKeypoints) {
  for (const std::uint64_t seed : {7u, 8u})
    for (const IssWeights weights : kBoth) {
      const Mesh mesh = uneven(seed);
      const double resolution = point_resolution(mesh.vertices);
      EXPECT_EQ(detect_iss(move_mesh(mesh, random_motion(mesh, seed)), resolution, with(weights)).vertices,
                detect_iss(mesh, resolution, with(weights)).vertices);
    }
}

TEST(DetectIss, ScaleByAPowerOfTwoIsExact) {
  const Mesh mesh = uneven(9);
  Mesh large = mesh;
  large.vertices *= 1024;
  const double resolution = point_resolution(mesh.vertices);
  for (const IssWeights weights : kBoth) {
    EXPECT_TRUE(iss_saliency(large, 1024 * resolution, with(weights)) ==
                1024 * 1024 * iss_saliency(mesh, resolution, with(weights)));
    EXPECT_EQ(detect_iss(large, 1024 * resolution, with(weights)).vertices,
              detect_iss(mesh, resolution, with(weights)).vertices);
  }
}

TEST(DetectIss, SameBitsHoweverItRuns) {
  const Mesh mesh = uneven(10);
  const double resolution = point_resolution(mesh.vertices);
  const Indices old_row = testing::shuffled_rows(mesh.vertices.rows(), 11);
  const Mesh other = testing::renumbered(mesh, old_row);
  for (const IssWeights weights : kBoth) {
    const Eigen::VectorXd expected = iss_saliency(mesh, resolution, with(weights));
    EXPECT_TRUE(iss_saliency(mesh, resolution, with(weights), testing::last_first) == expected);
    EXPECT_TRUE(iss_saliency(mesh, resolution, with(weights), testing::on_three_threads) == expected);
    EXPECT_TRUE(iss_saliency(other, resolution, with(weights)) == expected(old_row));
    const Indices keypoints = detect_iss(mesh, resolution, with(weights)).vertices;
    EXPECT_EQ(testing::by_old_name(detect_iss(other, resolution, with(weights)).vertices, old_row), keypoints);
    for (const std::int64_t target : testing::available_targets()) {
      const testing::ForcedTarget forced(target);
      EXPECT_TRUE(iss_saliency(mesh, resolution, with(weights)) == expected);
      EXPECT_EQ(detect_iss(mesh, resolution, with(weights)).vertices, keypoints);
    }
  }
}

TEST(DetectIss, TooLittleSurfaceGivesNone) {
  for (const Points& points : {Points(0, 3), Points(Points::Random(2, 3)), Points(Points::Ones(100, 3))})
    for (const IssWeights weights : kBoth) {
      EXPECT_THAT(detect_iss(cloud(points), 1, with(weights)).vertices, IsEmpty());
      EXPECT_EQ(iss_saliency(cloud(points), 1, with(weights)).size(), points.rows());
    }
}

TEST(DetectIss, OptionsAreChecked) {
  const Mesh mesh = testing::icosphere(1);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(detect_iss(mesh, bad), InvalidInput);
    const auto refusal = [&](double IssOptions::*field) {
      IssOptions options;
      options.*field = bad;
      return testing::refusal_of([&] { detect_iss(mesh, 1, options); });
    };
    EXPECT_THAT(refusal(&IssOptions::salient_radius_pr), HasSubstr("salient_radius_pr"));
    EXPECT_THAT(refusal(&IssOptions::non_max_radius_pr), HasSubstr("non_max_radius_pr"));
    EXPECT_THAT(refusal(&IssOptions::density_radius_pr), HasSubstr("density_radius_pr"));
    EXPECT_THAT(refusal(&IssOptions::gamma_21), HasSubstr("gamma_21"));
    EXPECT_THAT(refusal(&IssOptions::gamma_32), HasSubstr("gamma_32"));
  }
  IssOptions options;
  options.minimum_neighbors = 0;
  EXPECT_THAT(testing::refusal_of([&] { detect_iss(mesh, 1, options); }), HasSubstr("minimum_neighbors"));
}

TEST(DetectIss, ARadiusThatHoldsACrowdIsRefused) {
  const Mesh crowd = cloud(Points::Random(6000, 3));
  EXPECT_THAT(testing::refusal_of([&] { detect_iss(crowd, 1); }), HasSubstr("2000 vertices on average"));
  IssOptions options;
  options.salient_radius_pr = options.non_max_radius_pr = 0.1;
  EXPECT_THAT(testing::refusal_of([&] { detect_iss(crowd, 1, options); }), HasSubstr("density radius"));
}

}  // namespace
}  // namespace corral
