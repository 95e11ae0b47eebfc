// SPDX-License-Identifier: MIT
// The options of matching: only what both sides want, and approximate trees.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/feature_matching.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Eigen::MatrixXd features(int size, int count, std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::MatrixXd columns(size, count);
  for (double& value : columns.reshaped()) value = random.uniform() < 0.3 ? random.uniform() : 0;
  columns.row(0).array() += 0.01;  // none is zero, which has no length to divide by
  columns.colwise().normalize();
  return columns;
}

/// Each column of the first once more, a little off, in another order; and as many others.
Eigen::MatrixXd partners_of(const Eigen::MatrixXd& source, double off, std::uint64_t seed) {
  Eigen::MatrixXd target(source.rows(), 2 * source.cols());
  target << source.rowwise().reverse() +
                off * features(static_cast<int>(source.rows()), static_cast<int>(source.cols()), seed),
      features(static_cast<int>(source.rows()), static_cast<int>(source.cols()), seed + 1);
  return target;
}

TEST(MatchFeatures, FeaturesThatAreNotFiniteAreRefused) {
  Eigen::MatrixXd good = features(12, 5, 1), bad = good;
  bad(3, 2) = std::nan("");
  EXPECT_THROW(match_features(bad, good), InvalidInput);
  EXPECT_THROW(match_features(good, bad), InvalidInput);
  bad(3, 2) = HUGE_VAL;
  EXPECT_THROW(match_features(good, bad), InvalidInput);
}

/// In what a sample of the features does not see, either.
TEST(MatchFeatures, FeaturesThatAreNotFiniteAreRefusedAmongThousands) {
  const Eigen::MatrixXd good = features(40, 3000, 1);
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (const int column : {0, 1, 1777, 2999})
      for (const Matcher matcher : {Matcher::Exact, Matcher::Flann}) {
        Eigen::MatrixXd bad = good;
        bad(39, column) = value;
        EXPECT_THROW(match_features(bad, good, {matcher, false}), InvalidInput)
            << choice_text(matcher) << " " << column;
        EXPECT_THROW(match_features(good, bad, {matcher, false}), InvalidInput)
            << choice_text(matcher) << " " << column;
      }
}

TEST(MutualMatches, AreThoseThatBothSidesWant) {
  for (const auto& [sources, targets] : {std::pair(80, 120), std::pair(120, 80), std::pair(1, 30), std::pair(30, 1)}) {
    const Eigen::MatrixXd source = features(12, sources, 1), target = features(12, targets, 2);
    const FeatureMatches all = match_features(source, target), back = match_features(target, source);
    const FeatureMatches mutual = match_features(source, target, {Matcher::Exact, true});
    Indices expected;
    for (int row = 0; row < sources; ++row)
      if (back.nearest[static_cast<std::size_t>(all.nearest[static_cast<std::size_t>(row)])] == row)
        expected.push_back(row);
    EXPECT_EQ(mutual.source, expected);
    EXPECT_FALSE(expected.empty());
    EXPECT_LT(expected.size(), static_cast<std::size_t>(std::max(sources, targets)));
    ASSERT_EQ(mutual.nearest.size(), expected.size());
    ASSERT_EQ(mutual.distance.size(), static_cast<Eigen::Index>(expected.size()));
    ASSERT_EQ(mutual.second_distance.size(), mutual.distance.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_EQ(mutual.nearest[i], all.nearest[static_cast<std::size_t>(expected[i])]);
      EXPECT_EQ(mutual.distance(row), all.distance(expected[i]));
      EXPECT_EQ(mutual.second_distance(row), all.second_distance(expected[i]));
    }
    Indices targets_taken = mutual.nearest;
    std::sort(targets_taken.begin(), targets_taken.end());
    EXPECT_EQ(std::adjacent_find(targets_taken.begin(), targets_taken.end()), targets_taken.end()) << "each once";
  }
}

TEST(MutualMatches, AreTheSameFromTheOtherSide) {
  const Eigen::MatrixXd source = features(20, 90, 3), target = features(20, 110, 4);
  const FeatureMatches there = match_features(source, target, {Matcher::Exact, true}),
                       back = match_features(target, source, {Matcher::Exact, true});
  std::vector<std::pair<int, int>> pairs, turned;
  for (std::size_t i = 0; i < there.source.size(); ++i) pairs.emplace_back(there.source[i], there.nearest[i]);
  for (std::size_t i = 0; i < back.source.size(); ++i) turned.emplace_back(back.nearest[i], back.source[i]);
  std::sort(turned.begin(), turned.end());
  EXPECT_EQ(pairs, turned);
}

TEST(MutualMatches, OfEqualsTheLowerOnesFindEachOther) {
  const Eigen::MatrixXd one = features(20, 1, 5);
  const FeatureMatches found = match_features(one.replicate(1, 4), one.replicate(1, 3), {Matcher::Exact, true});
  EXPECT_THAT(found.source, ElementsAre(0));
  EXPECT_THAT(found.nearest, ElementsAre(0));
}

TEST(MutualMatches, ReachTheTable) {
  Mesh mesh{Points::Random(9, 3), Triangles(0, 3)};
  Descriptors source, target;
  source.vertices = {8, 3, 5}, target.vertices = {2, 7};
  source.features.resize(1, 3), target.features.resize(1, 2);
  source.features << 0.9, 0.1, 0.2;  // the second and the third want the second target, which wants the second
  target.features << 1, 0;
  for (int i = 0; i < 3; ++i) source.frames.push_back((i + 1) * LocalReferenceFrame::Identity());
  for (int i = 0; i < 2; ++i) target.frames.push_back((i + 7) * LocalReferenceFrame::Identity());
  const CorrespondenceSet matches = make_correspondences({mesh, source}, {mesh, target}, 1, {Matcher::Exact, true});
  EXPECT_THAT(matches.source_keypoints, ElementsAre(8, 3));
  EXPECT_THAT(matches.target_keypoints, ElementsAre(2, 7));
  EXPECT_EQ(matches.source_frames[1](0, 0), 2);
  EXPECT_EQ(matches.target_frames[1](0, 0), 8);
  EXPECT_EQ(matches.source_points.row(1), mesh.vertices.row(3));
  EXPECT_EQ(matches.target_points.row(1), mesh.vertices.row(7));
  EXPECT_EQ(matches.size(), 2);
}

TEST(FlannMatches, FindNearlyAllAndMeasureThemExactly) {
  const Eigen::MatrixXd source = features(352, 400, 6), target = partners_of(source, 0.05, 7);
  const FeatureMatches exact = match_features(source, target),
                       found = match_features(source, target, {Matcher::Flann, false});
  EXPECT_EQ(found.source, exact.source);
  int right = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    right += found.nearest[i] == exact.nearest[i];
    EXPECT_DOUBLE_EQ(found.distance(row), (source.col(row) - target.col(found.nearest[i])).norm());
    EXPECT_GE(found.distance(row), exact.distance(row) * (1 - 1e-12)) << "nothing is nearer than the nearest";
    EXPECT_GE(found.second_distance(row), found.distance(row));
    EXPECT_GE(found.second_distance(row), exact.second_distance(row) * (1 - 1e-12));
  }
  EXPECT_GE(right, 392);
}

TEST(FlannMatches, TakePartInMutualOnes) {
  const Eigen::MatrixXd source = features(60, 100, 8), target = partners_of(source, 0.02, 9);
  const FeatureMatches found = match_features(source, target, {Matcher::Flann, true});
  EXPECT_GE(found.source.size(), 90u);
  EXPECT_TRUE(std::is_sorted(found.source.begin(), found.source.end()));
  EXPECT_EQ(found.nearest.size(), found.source.size());
}

TEST(FlannMatches, FewFeaturesAreEnough) {
  const FeatureMatches one = match_features(features(20, 4, 10), features(20, 1, 11), {Matcher::Flann, false});
  EXPECT_THAT(one.nearest, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(one.second_distance, Eigen::VectorXd(Eigen::VectorXd::Zero(4)));
  for (const auto& [sources, targets] : {std::pair(0, 3), std::pair(3, 0), std::pair(0, 0)})
    for (const Matcher matcher : {Matcher::Exact, Matcher::Flann})
      for (const bool mutual : {false, true})
        EXPECT_THAT(
            match_features(Eigen::MatrixXd::Zero(5, sources), Eigen::MatrixXd::Zero(5, targets), {matcher, mutual})
                .source,
            IsEmpty());
}

TEST(MatchingOptions, OtherMatchersAreRefused) {
  for (const char* bad : {"", "Exact", "kdtree", "flann "})
    EXPECT_THAT(testing::refusal_of([&] {
                  parse_options<MatchingOptions>({{"matcher", bad}}, "match");
                }),
                AllOf(HasSubstr("'" + std::string(bad) + "'"), HasSubstr("exact|flann")));
}

}  // namespace
}  // namespace corral
