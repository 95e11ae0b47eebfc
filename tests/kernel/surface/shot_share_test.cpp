// SPDX-License-Identifier: MIT
// The angles of SHOT come from a polynomial and its bins from comparisons: against std::atan2, and at every border.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/execution.h"
#include "tests/support/reference/shot.h"

namespace corral {
namespace {

using testing::shot_bin;

constexpr double kRadius = 4;

/// What one vertex, its normal along z, gives to each bin. A second vertex with nothing to share is the unit: it sits in
/// the middle of a bin of the lowest cosine, the first gives to bins of the highest.
Eigen::VectorXd votes_of(const Eigen::Vector3d& place) {
  Support support;
  support.add(place, {0, 0, 1});
  const double flat = std::sqrt(0.5), turn = std::acos(-1.0) / 8;
  support.add({flat * std::cos(turn), flat * std::sin(turn), flat}, {0, 0, -1});
  Eigen::VectorXd votes = testing::fresh_histogram(support, LocalReferenceFrame::Identity(), kRadius).value();
  votes *= 4 / votes(shot_bin(4, 0, 1, 0));
  for (int bin = 0; bin < kShotSize; bin += 11) votes(bin) = 0;
  return votes;
}

Eigen::VectorXd expected_votes(const Eigen::Vector3d& place) {
  return testing::reference_shot_votes(place.transpose(), Eigen::RowVector3d(0, 0, 1), Eigen::Vector3d::Zero(),
                                       LocalReferenceFrame::Identity(), kRadius);
}

TEST(ShotShares, AzimuthIsThatOfTheArcTangent) {
  double largest = 0;
  for (int step = -18000; step < 18000; ++step) {
    const double angle = (step + 0.37) * std::acos(-1.0) / 18000;
    const Eigen::Vector3d place(0.9 * std::cos(angle), 0.9 * std::sin(angle), 0.5);
    largest = std::max(largest, (votes_of(place) - expected_votes(place)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(largest, 1e-11);
  EXPECT_GT(largest, 0) << "it is compared with something else";
}

TEST(ShotShares, ElevationIsThatOfTheArcCosine) {
  for (const double azimuth : {0.3, 1.0, -2.5}) {
    double largest = 0;
    for (int step = 1; step < 18000; ++step) {  // down from the pole, near which the arc cosine itself is coarse
      const double angle = (step + 0.37) * std::acos(-1.0) / 18001;
      if (std::sin(angle) < 0.01) continue;
      const Eigen::Vector3d place(1.5 * std::sin(angle) * std::cos(azimuth), 1.5 * std::sin(angle) * std::sin(azimuth),
                                  1.5 * std::cos(angle));
      largest = std::max(largest, (votes_of(place) - expected_votes(place)).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(largest, 1e-11) << azimuth;
  }
}

TEST(ShotShares, NextToTheBordersNoShareIsNegative) {
  double least = 1;
  for (int step = -1000; step <= 1000; ++step) {
    const double angle = std::acos(-1.0) / 4 + step * 1e-14;
    for (const double x : {0.3, 0.7, 1.1})
      for (const double turn : {1.0, -1.0}) {
        const Eigen::Vector3d place(x, 0, turn * x * std::tan(angle));
        least = std::min({least, votes_of(place).minCoeff(), votes_of({0, -x, place.z()}).minCoeff()});
      }
  }
  EXPECT_GE(least, 0);
}

TEST(ShotShares, NextToTheBordersTheSectorsAreRight) {
  for (int border = -4; border < 4; ++border)
    for (const double aside : {-1e-9, -1e-13, 1e-13, 1e-9}) {
      const double angle = border * std::acos(-1.0) / 4 + aside;
      const Eigen::Vector3d place(std::cos(angle), std::sin(angle), 0.6);
      EXPECT_LT((votes_of(place) - expected_votes(place)).cwiseAbs().maxCoeff(), 1e-11) << border << " " << aside;
    }
}

/// The own bin got most.
int azimuth_of(const Eigen::VectorXd& votes) {
  Eigen::Index bin = 0;
  EXPECT_GE(votes.maxCoeff(&bin), 2);
  return static_cast<int>(bin / 44);
}

TEST(ShotShares, ASectorHoldsItsUpperBorder) {
  struct Border {
    double x, y;
    int sector;
  };
  const Border borders[] = {{-1, -1, 0}, {0, -1, 1}, {1, -1, 2}, {1, 0, 3},
                            {1, 1, 4},   {0, 1, 5},  {-1, 1, 6}, {-1, 0, 7}};
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    for (const Border& border : borders)
      for (const double scale : {1.0, 0.1, 0.3, 1e-3, 1.2, 1e-200})
        for (const double zero : {0.0, -0.0}) {
          const double x = border.x == 0 ? zero : scale * border.x, y = border.y == 0 ? zero : scale * border.y;
          const Eigen::VectorXd votes = votes_of({x, y, 0.4});
          EXPECT_EQ(azimuth_of(votes), border.sector) << x << " " << y;
          const int beside = (border.sector + 1) % 8;
          for (int sector = 0; sector < 8; ++sector)
            if (sector != border.sector) {
              EXPECT_NEAR(votes(shot_bin(sector, 0, 1, 10)), sector == beside ? 0.5 : 0, 1e-12) << x << " " << y;
            }
        }
  }
}

TEST(ShotShares, OneBitBesideABorderIsTheOtherSector) {
  const double more = std::nextafter(1.0, 2);
  EXPECT_EQ(azimuth_of(votes_of({1, 1, 0.4})), 4);
  EXPECT_EQ(azimuth_of(votes_of({1, 5e-324, 0.4})), 4) << "just above 0";
  EXPECT_EQ(azimuth_of(votes_of({-1, -5e-324, 0.4})), 0) << "just above -180";
  EXPECT_EQ(azimuth_of(votes_of({more, 1, 0.4})), 4);
}

TEST(ShotShares, HalvesAndShellsAreDecidedByComparison) {
  const auto home = [](const Eigen::Vector3d& place) {
    Eigen::Index bin = 0;
    votes_of(place).maxCoeff(&bin);
    return std::pair(static_cast<int>(bin / 22 % 2), static_cast<int>(bin / 11 % 2));
  };
  EXPECT_EQ(home({0.7, 0.3, 0.0}), std::pair(0, 0)) << "the plane belongs to the lower half";
  EXPECT_EQ(home({0.7, 0.3, -0.0}), std::pair(0, 0));
  EXPECT_EQ(home({0.7, 0.3, 5e-324}), std::pair(0, 1));
  EXPECT_EQ(home({2, 0, 0}), std::pair(0, 0)) << "R / 2 belongs to the inner shell";
  EXPECT_EQ(home({0, std::nextafter(2.0, 3), 0}), std::pair(1, 0));
}

TEST(ShotShares, PlacesWithWholeCoordinatesAgreeWithTheReference) {
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) {
        const Eigen::Vector3d place(x, y, z);
        if (place.norm() > kRadius || place.isZero(0)) continue;
        EXPECT_LT((votes_of(place) - expected_votes(place)).cwiseAbs().maxCoeff(), 1e-11) << place.transpose();
      }
}

}  // namespace
}  // namespace corral
