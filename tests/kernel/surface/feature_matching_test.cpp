// SPDX-License-Identifier: MIT
#include "kernel/surface/feature_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <flann/flann.hpp>
#include <vector>

#include "kernel/random.h"

namespace corral {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Columns that are not negative and of unit length, as histograms are. No entry is zero: features without a bin in common
/// are all as far apart, and rounding would choose between them.
Eigen::MatrixXd features(int size, int count, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXd columns(size, count);
  for (int column = 0; column < count; ++column)
    for (int row = 0; row < size; ++row) columns(row, column) = (random.uniform() < 0.3 ? 1 : 0.02) * random.uniform();
  columns.colwise().normalize();
  return columns;
}

/// One source after the other, difference by difference; the first of equals is the nearest.
FeatureMatches reference_matches(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  FeatureMatches matches;
  matches.distance.resize(source.cols());
  matches.second_distance.resize(source.cols());
  for (Eigen::Index i = 0; i < source.cols(); ++i) {
    std::vector<std::pair<double, int>> all;
    for (int j = 0; j < target.cols(); ++j) all.emplace_back((source.col(i) - target.col(j)).squaredNorm(), j);
    std::sort(all.begin(), all.end());
    matches.source.push_back(static_cast<int>(i));
    matches.nearest.push_back(all[0].second);
    matches.distance(i) = std::sqrt(all[0].first);
    matches.second_distance(i) = all.size() > 1 ? std::sqrt(all[1].first) : 0;
  }
  return matches;
}

void expect_agrees(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  const FeatureMatches found = match_features(source, target);
  const FeatureMatches expected = reference_matches(source, target);
  EXPECT_EQ(found.source, expected.source);
  EXPECT_EQ(found.nearest, expected.nearest);
  ASSERT_EQ(found.distance.size(), source.cols());
  ASSERT_EQ(found.second_distance.size(), source.cols());
  EXPECT_LT((found.distance - expected.distance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((found.second_distance - expected.second_distance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(MatchFeatures, AgreesWithBruteForce) {
  for (const int targets : {1, 2, 3, 63, 64, 65, 700})
    for (const int sources : {1, 5, 129, 300}) expect_agrees(features(40, sources, 1), features(40, targets, 2));
  expect_agrees(features(352, 260, 3), features(352, 530, 4));
}

TEST(MatchFeatures, NearlyEqualDistancesAreTold) {
  // Targets in pairs that differ by one part in 10^10, far below the rounding of a product of norms.
  Eigen::MatrixXd target = features(352, 300, 5);
  RandomStream random(6);
  for (int column = 1; column < 300; column += 2) {
    target.col(column) = target.col(column - 1);
    target(static_cast<Eigen::Index>(random.below(352)), column) += 1e-10;
  }
  expect_agrees(features(352, 100, 7), target);
  expect_agrees(target, target);
}

TEST(MatchFeatures, NearlyEqualFeaturesAreTold) {
  // Distances of 1e-9 and less: their squares drown in the rounding of a product of norms.
  Eigen::MatrixXd target = features(352, 1, 16).replicate(1, 120), source = target.leftCols(40);
  RandomStream random(17);
  for (int column = 0; column < 120; ++column)
    target(static_cast<Eigen::Index>(random.below(352)), column) += random.uniform(1e-10, 1e-9);
  for (int column = 0; column < 40; ++column)
    source(static_cast<Eigen::Index>(random.below(352)), column) += random.uniform(1e-10, 1e-9);
  expect_agrees(source, target);
}

TEST(MatchFeatures, AgreesWithAnExactLinearIndex) {
  const Eigen::MatrixXd source = features(352, 200, 8), target = features(352, 400, 9);
  Eigen::MatrixXf source_float = source.cast<float>(), target_float = target.cast<float>();
  flann::Index<flann::L2<float>> index(flann::Matrix<float>(target_float.data(), 400, 352), flann::LinearIndexParams());
  index.buildIndex();
  std::vector<std::vector<int>> rows;
  std::vector<std::vector<float>> squared;
  index.knnSearch(flann::Matrix<float>(source_float.data(), 200, 352), rows, squared, 2, flann::SearchParams());
  const FeatureMatches found = match_features(source, target);
  for (std::size_t i = 0; i < 200; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(found.distance(row), std::sqrt(squared[i][0]), 1e-5);
    EXPECT_NEAR(found.second_distance(row), std::sqrt(squared[i][1]), 1e-5);
    if (found.second_distance(row) - found.distance(row) > 1e-5) {
      EXPECT_EQ(found.nearest[i], rows[i][0]);
    }
  }
}

TEST(MatchFeatures, TiesGoToTheLowerColumn) {
  const Eigen::MatrixXd one = features(352, 1, 10);
  const Eigen::MatrixXd target = one.replicate(1, 200);
  const FeatureMatches found = match_features(features(352, 150, 11), target);
  EXPECT_THAT(found.nearest, Each(0));
  EXPECT_EQ(found.distance, found.second_distance);

  Eigen::MatrixXd mirrored(2, 3);  // at equal distance on both sides of the source, and one farther away
  mirrored << 2, 1, -1, 0, 0, 0;
  EXPECT_THAT(match_features(Eigen::MatrixXd::Zero(2, 1), mirrored).nearest, ElementsAre(1));
}

TEST(MatchFeatures, EqualFeatureIsAtDistanceZero) {
  const Eigen::MatrixXd both = features(352, 90, 12);
  const FeatureMatches found = match_features(both, both);
  for (int i = 0; i < 90; ++i) EXPECT_EQ(found.nearest[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(found.distance.cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(found.second_distance.minCoeff(), 0);
}

TEST(MatchFeatures, SingleTargetHasNoSecond) {
  const FeatureMatches found = match_features(features(20, 4, 13), features(20, 1, 14));
  EXPECT_THAT(found.nearest, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(found.second_distance, Eigen::VectorXd(Eigen::VectorXd::Zero(4)));
  EXPECT_GT(found.distance.minCoeff(), 0);
}

TEST(MatchFeatures, EmptySideGivesNothing) {
  for (const auto& [sources, targets] : {std::pair(0, 3), std::pair(3, 0), std::pair(0, 0)}) {
    const FeatureMatches found = match_features(Eigen::MatrixXd::Zero(20, sources), Eigen::MatrixXd::Zero(20, targets));
    EXPECT_THAT(found.nearest, IsEmpty());
    EXPECT_EQ(found.distance.size(), 0);
    EXPECT_EQ(found.second_distance.size(), 0);
  }
}

TEST(MakeCorrespondences, RowsFollowTheSourceKeypoints) {
  Mesh source, target;
  source.vertices = Points::Random(10, 3);
  target.vertices = Points::Random(12, 3);
  Descriptors source_side, target_side;
  source_side.vertices = {7, 2, 9};
  target_side.vertices = {11, 4};
  source_side.features = Eigen::MatrixXd::Zero(2, 3);
  source_side.features << 1, 0, 0.9, 0, 1, 0.1;
  target_side.features = Eigen::MatrixXd::Identity(2, 2);
  for (int i = 0; i < 3; ++i) source_side.frames.push_back((i + 1) * Eigen::Matrix3d::Identity());
  for (int i = 0; i < 2; ++i) target_side.frames.push_back((i + 5) * Eigen::Matrix3d::Identity());

  const CorrespondenceSet matches = make_correspondences({source, source_side}, {target, target_side}, 0.25);
  EXPECT_NO_THROW(matches.validate());
  EXPECT_THAT(matches.source_keypoints, ElementsAre(7, 2, 9));
  EXPECT_THAT(matches.target_keypoints, ElementsAre(11, 4, 11));
  for (int row = 0; row < 3; ++row) {
    const auto i = static_cast<std::size_t>(row);
    EXPECT_EQ(matches.source_points.row(row), source.vertices.row(matches.source_keypoints[i]));
    EXPECT_EQ(matches.target_points.row(row), target.vertices.row(matches.target_keypoints[i]));
    EXPECT_EQ(matches.source_frames[i](0, 0), row + 1);
    EXPECT_EQ(matches.target_frames[i](0, 0), row == 1 ? 6 : 5);
  }
  EXPECT_NEAR(matches.feature_distance(2), std::sqrt(0.02), 1e-15);
  EXPECT_NEAR(matches.second_feature_distance(2), std::sqrt(0.81 + 0.81), 1e-15);
  EXPECT_EQ(matches.resolution, 0.25);
  ASSERT_TRUE(matches.source_centroid.has_value());
  EXPECT_LT((*matches.source_centroid - source.vertices.colwise().mean().transpose()).norm(), 1e-15);
}

TEST(MakeCorrespondences, NoDescriptorsGiveAnEmptyTable) {
  const Mesh mesh{Points::Random(5, 3), Triangles(0, 3)};
  Descriptors none, one;
  none.features = Eigen::MatrixXd::Zero(352, 0);
  one.features = features(352, 1, 15);
  one.vertices = {3};
  one.frames = {Eigen::Matrix3d::Identity()};
  EXPECT_EQ(make_correspondences({mesh, none}, {mesh, one}, 1).size(), 0);
  EXPECT_EQ(make_correspondences({mesh, one}, {mesh, none}, 1).size(), 0);
  EXPECT_NO_THROW(make_correspondences({mesh, one}, {mesh, none}, 1).validate());
}

}  // namespace
}  // namespace corral
