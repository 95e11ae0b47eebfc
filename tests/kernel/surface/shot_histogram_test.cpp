// SPDX-License-Identifier: MIT
#include "kernel/surface/shot.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "kernel/random.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/resolution.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/shot.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::fresh_histogram;
using testing::points_of;
using testing::shot_bin;
using testing::support_of;

/// The histogram of one neighbour at `place`, its normal at `cosine` to the z axis, in a frame along the axes.
Eigen::VectorXd single(const Eigen::Vector3d& place, double cosine, double radius = 4,
                       ShotForm form = ShotForm::Additive) {
  Support support;
  support.add(place, {std::sqrt(1 - cosine * cosine), 0, cosine});
  const auto histogram = fresh_histogram(support, LocalReferenceFrame::Identity(), radius, form);
  return histogram.value_or(Eigen::VectorXd::Zero(kShotSize));
}

/// The place at a distance, degrees from +z, and degrees of azimuth.
Eigen::Vector3d polar(double distance, double elevation_deg, double azimuth_deg) {
  const double e = elevation_deg * std::acos(-1.0) / 180, a = azimuth_deg * std::acos(-1.0) / 180;
  return distance * Eigen::Vector3d(std::sin(e) * std::cos(a), std::sin(e) * std::sin(a), std::cos(e));
}

TEST(ShotHistogram, AgreesWithTheReference) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Mesh mesh = testing::bumpy_sphere(4, seed);
    const Points normals = estimate_normals(mesh);
    for (const double radius_pr : {5.0, 15.0}) {
      const double radius = radius_pr * point_resolution(mesh.vertices);
      for (int row = 0; row < mesh.vertices.rows(); row += 17) {
        const Eigen::Vector3d point = mesh.vertices.row(row).transpose();
        const auto frame = testing::reference_shot_frame(mesh.vertices, point, radius);
        const Support support = support_of(mesh.vertices, normals, point, radius);
        for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product}) {
          const auto found = fresh_histogram(support, *frame, radius, form);
          const auto expected = testing::reference_shot_histogram(mesh.vertices, normals, point, *frame, radius, form);
          ASSERT_TRUE(found.has_value());
          ASSERT_EQ(found->size(), kShotSize);
          EXPECT_LT((*found - *expected).cwiseAbs().maxCoeff(), 1e-9) << row << " " << choice_text(form);
          EXPECT_NEAR(found->norm(), 1, 1e-12);
          EXPECT_GE(found->minCoeff(), 0);
        }
      }
    }
  }
}

TEST(ShotHistogram, CentreOfABinGivesToNoOther) {
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int elevation = 0; elevation < 2; ++elevation)
      for (int shell = 0; shell < 2; ++shell)
        for (int cosine = 0; cosine <= 10; ++cosine) {
          const Eigen::VectorXd histogram =
              single(polar(1 + 2 * shell, 45 + 90 * elevation, -157.5 + 45 * azimuth), 0.2 * cosine - 1);
          EXPECT_NEAR(histogram(shot_bin(azimuth, shell, 1 - elevation, cosine)), 1, 1e-12);
          EXPECT_NEAR(histogram.sum(), 1, 1e-12);
        }
}

TEST(ShotHistogram, EachAxisGivesToItsNeighbourByItself) {
  // In the upper half of sector 5, inner shell, cosine 6: 0.1 off in cosine, 0.2 in radius, 0.3 in elevation, 0.4 in azimuth; 3 stay.
  const Eigen::VectorXd histogram = single(polar(1.4, 45 + 27, 67.5 + 18), 0.22);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
  expected(shot_bin(5, 0, 1, 6)) = 0.9 + 0.8 + 0.7 + 0.6;
  expected(shot_bin(5, 0, 1, 7)) = 0.1;
  expected(shot_bin(5, 1, 1, 6)) = 0.2;
  expected(shot_bin(5, 0, 0, 6)) = 0.3;
  expected(shot_bin(6, 0, 1, 6)) = 0.4;
  EXPECT_LT((histogram - expected.normalized()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShotHistogram, WeightBeyondTheOutermostCentresIsLost) {
  // In the lower half of sector 0, outer shell, cosine 10: 0.3 beyond the outer shell, 0.2 below the lower half, azimuth 0.25 towards sector 7.
  const Eigen::VectorXd histogram = single(polar(3.6, 135 + 18, -157.5 - 11.25), 0.92);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
  expected(shot_bin(0, 1, 0, 10)) = 0.6 + 0.7 + 0.8 + 0.75;
  expected(shot_bin(0, 1, 0, 9)) = 0.4;
  expected(shot_bin(7, 1, 0, 10)) = 0.25;
  EXPECT_LT((histogram - expected.normalized()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShotHistogram, LastCosineBinIsNotWrapped) {
  const Eigen::VectorXd histogram = single(polar(1, 45, 22.5), 0.86);  // 9.3: 0.3 to bin 10, none to bin 0
  EXPECT_NEAR(histogram(shot_bin(4, 0, 1, 10)) / histogram(shot_bin(4, 0, 1, 9)), 0.3 / 3.7, 1e-12);
  EXPECT_EQ(histogram(shot_bin(4, 0, 1, 0)), 0);
}

TEST(ShotHistogram, CosineOutsideItsRangeIsClamped) {
  for (const double sign : {1.0, -1.0}) {
    Support support;
    support.add(polar(1, 45, 22.5), {0, 0, sign * (1 + 1e-9)});
    const auto histogram = fresh_histogram(support, LocalReferenceFrame::Identity(), 4);
    ASSERT_TRUE(histogram.has_value());
    EXPECT_NEAR((*histogram)(shot_bin(4, 0, 1, sign > 0 ? 10 : 0)), 1, 1e-8);
  }
}

TEST(ShotHistogram, EveryPlaceAndNormalFindsABin) {
  const double root = std::sqrt(0.5);
  for (const double x : {-2.0, -root, -0.0, 0.0, root, 2.0})
    for (const double y : {-2.0, -root, -0.0, 0.0, root, 2.0})
      for (const double z : {-2.0, -root, -0.0, 0.0, root, 2.0})
        for (const double cosine : {-1.0, -0.9, -0.1, 0.0, 0.1, 0.9, 1.0}) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Eigen::VectorXd histogram = single({x, y, z}, cosine);
          EXPECT_TRUE(histogram.allFinite());
          EXPECT_NEAR(histogram.norm(), 1, 1e-12) << x << " " << y << " " << z << " " << cosine;
        }
}

TEST(ShotHistogram, IsAbsentWithoutANormal) {
  const Points vertices = testing::icosphere(2).vertices;
  const Support support = support_of(vertices, Points::Zero(vertices.rows(), 3), {0, 0, 1}, 0.9);
  EXPECT_GT(support.count, 10);
  for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product}) {
    EXPECT_FALSE(fresh_histogram(support, LocalReferenceFrame::Identity(), 0.9, form).has_value());
    EXPECT_FALSE(fresh_histogram(Support(), LocalReferenceFrame::Identity(), 0.9, form).has_value());
  }
}

TEST(ShotHistogram, LeavesItsBinsAsItFoundThem) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  const Points normals = estimate_normals(mesh);
  const double radius = 12 * point_resolution(mesh.vertices);
  ShotBins bins;
  for (const ShotForm form : {ShotForm::Additive, ShotForm::Product, ShotForm::PclBug})
    for (int row = 0; row < mesh.vertices.rows(); row += 11) {
      const Support support = support_of(mesh.vertices, normals, mesh.vertices.row(row).transpose(), radius);
      const auto frame = shot_frame(support, radius).value();
      EXPECT_EQ(shot_histogram(support, frame, radius, form, bins), fresh_histogram(support, frame, radius, form))
          << row;
      for (const auto& copy : bins.votes)
        EXPECT_TRUE(std::all_of(std::begin(copy), std::end(copy), [](double votes) { return votes == 0; })) << row;
    }
}

// Beyond the last centre of an axis that ends there is nobody to share with: half of that vote is lost.
TEST(ShotHistogram, TheRimGivesNothingToTheInnerShell) {
  const Eigen::VectorXd rim = single({2, 0, 0}, 1, 2);
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int above = 0; above < 2; ++above)
      EXPECT_EQ(rim(shot_bin(azimuth, 0, above, 10)), 0) << azimuth << " " << above;
}

TEST(ShotHistogram, StraightDownGivesNothingToTheUpperHalf) {
  const Eigen::VectorXd down = single({0, 0, -1.5}, 1, 2);
  for (int azimuth = 0; azimuth < 8; ++azimuth)
    for (int shell = 0; shell < 2; ++shell)
      EXPECT_EQ(down(shot_bin(azimuth, shell, 1, 10)), 0) << azimuth << " " << shell;
}

// The slip of that library: what bin 9 owes to bin 10 goes to bin 0. Nothing else differs.
TEST(ShotHistogram, PclWrapsTheCosineOfBinNine) {
  for (int step = -1000; step <= 1000; ++step) {
    const double cosine = step / 1000.0, position = 5 * (1 + cosine);
    const Eigen::VectorXd additive = single(polar(1, 45, 22.5), cosine),
                          pcl = single(polar(1, 45, 22.5), cosine, 4, ShotForm::PclBug);
    Eigen::VectorXd expected = additive;
    if (position > 9 && position < 9.5) {
      std::swap(expected(shot_bin(4, 0, 1, 10)), expected(shot_bin(4, 0, 1, 0)));
      EXPECT_GT(pcl(shot_bin(4, 0, 1, 0)), 0) << cosine;
    }
    EXPECT_EQ(pcl, expected) << cosine;
  }
}

TEST(ShotHistogram, ProductSharesMultiply) {
  // 0.1 off in cosine, 0.2 in radius, 0.3 in elevation, 0.4 in azimuth.
  const Eigen::VectorXd histogram = single(polar(1.4, 45 + 27, 67.5 + 18), 0.22, 4, ShotForm::Product);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
  for (const auto& [azimuth, a] : {std::pair(5, 0.6), std::pair(6, 0.4)})
    for (const auto& [shell, r] : {std::pair(0, 0.8), std::pair(1, 0.2)})
      for (const auto& [above, e] : {std::pair(1, 0.7), std::pair(0, 0.3)})
        for (const auto& [cosine, c] : {std::pair(6, 0.9), std::pair(7, 0.1)})
          expected(shot_bin(azimuth, shell, above, cosine)) = a * r * e * c;
  EXPECT_NEAR(expected.sum(), 1, 1e-15);
  EXPECT_LT((histogram - expected.normalized()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ShotHistogram, ProductVotesAddUpToTheirNumber) {
  // Between the outermost centres nothing is lost. Before its length is made one the histogram holds one vote a vertex.
  RandomStream random(3);
  Points vertices(500, 3), normals(500, 3);
  for (int row = 0; row < 500; ++row) {
    vertices.row(row) = polar(random.uniform(1, 3), random.uniform(45, 135), random.uniform(-180, 180)).transpose();
    normals.row(row) = random.direction().transpose();
  }
  const auto frame = LocalReferenceFrame::Identity();
  const auto found = fresh_histogram(support_of(vertices, normals, {0, 0, 0}, 4), frame, 4, ShotForm::Product);
  const Eigen::VectorXd votes =
      testing::reference_shot_votes(vertices, normals, {0, 0, 0}, frame, 4, ShotForm::Product);
  EXPECT_NEAR(votes.sum(), 500, 1e-9);
  EXPECT_NEAR(found.value().sum() * votes.norm(), 500, 1e-9);
}

TEST(ShotHistogram, OnTheZAxisThereIsNoAzimuthToShare) {
  for (const double z : {1.0, -1.0, 3.0}) {
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(kShotSize);
    expected(shot_bin(0, std::abs(z) > 2, z > 0, 6)) = 1;
    for (const ShotForm form : {ShotForm::Additive, ShotForm::PclBug, ShotForm::Product})
      EXPECT_LT((single({0, 0, z}, 0.2, 4, form) - expected).cwiseAbs().maxCoeff(), 1e-12)
          << z << " " << choice_text(form);
  }
}

}  // namespace
}  // namespace corral
