// SPDX-License-Identifier: MIT
#include "grouping/ransac.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grouping/pose/pose_score.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::table_of_points;

RansacOptions options_of(double tolerance_pr, int iterations = 200) {
  RansacOptions options;
  options.tolerance_pr = tolerance_pr;
  options.iterations = iterations;
  return options;
}

void expect_nothing(const GroupingResult& result) {
  EXPECT_THAT(result.selected, IsEmpty());
  EXPECT_FALSE(result.target_from_source.has_value());
}

// One triangle whose apex is 3 higher in the target. By symmetry the best motion is the shift by the means, (0, 1, 0):
// the residuals are 1, 1 and 2.
CorrespondenceSet raised_triangle() {
  return table_of_points({{-3, 0, 0}, {3, 0, 0}, {0, 3, 0}}, {{-3, 0, 0}, {3, 0, 0}, {0, 6, 0}});
}

TEST(Ransac, ResidualBelowTheToleranceAgrees) {
  EXPECT_THAT(group_by_ransac(raised_triangle(), options_of(2 + 1e-9)).selected, ElementsAre(0, 1, 2));
  EXPECT_THAT(group_by_ransac(raised_triangle(), options_of(2 - 1e-9)).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_ransac(raised_triangle(), options_of(2)).selected, ElementsAre(0, 1));
  const GroupingResult result = group_by_ransac(raised_triangle(), options_of(1 + 1e-9));
  EXPECT_THAT(result.selected, ElementsAre(0, 1));
  ASSERT_TRUE(result.target_from_source.has_value());
  EXPECT_TRUE(result.target_from_source->rotation.isIdentity(1e-12));
  EXPECT_TRUE(result.target_from_source->translation.isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_THAT(result.scores, IsEmpty());
}

TEST(Ransac, NoAgreementGivesNoPose) { expect_nothing(group_by_ransac(raised_triangle(), options_of(1 - 1e-9))); }

TEST(Ransac, ToleranceIsInPr) {
  CorrespondenceSet matches = raised_triangle();
  matches.resolution = 0.25;  // tolerances 1.5 and 2.5
  EXPECT_THAT(group_by_ransac(matches, options_of(6)).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_ransac(matches, options_of(10)).selected, ElementsAre(0, 1, 2));
}

TEST(Ransac, FewerThanThreeMatchesGiveNothing) {
  expect_nothing(group_by_ransac(table_of_points({{0, 0, 0}, {9, 0, 0}}, {{0, 0, 0}, {9, 0, 0}})));
  expect_nothing(group_by_ransac(table_of_points({{0, 0, 0}}, {{0, 0, 0}})));
}

TEST(Ransac, TriplesWithoutAreaGiveNothing) {
  const std::vector<testing::Row3> line = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {50, 0, 0}};
  const std::vector<testing::Row3> plane = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 0}};
  const std::vector<testing::Row3> place = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  for (const auto& flat : {line, place}) {
    expect_nothing(group_by_ransac(table_of_points(flat, flat), options_of(5)));
    expect_nothing(group_by_ransac(table_of_points(flat, plane), options_of(5)));
    expect_nothing(group_by_ransac(table_of_points(plane, flat), options_of(5)));
  }
}

TEST(Ransac, SmallestAreaIsInSquaredPr) {
  // Right triangles with legs a: area a^2 / 2 against 0.001 pr^2.
  constexpr double kBelow = 0.0447, kAbove = 0.0448;  // 0.000999 and 0.001004
  for (const double resolution : {1.0, 0.01, 50.0}) {
    const auto answer = [&](double source_leg, double target_leg) {
      const double a = source_leg * resolution, b = target_leg * resolution;
      CorrespondenceSet matches = table_of_points({{0, 0, 0}, {a, 0, 0}, {0, a, 0}}, {{0, 0, 0}, {b, 0, 0}, {0, b, 0}});
      matches.resolution = resolution;
      return group_by_ransac(matches, options_of(5));
    };
    expect_nothing(answer(kBelow, kBelow));
    expect_nothing(answer(kBelow, kAbove));
    expect_nothing(answer(kAbove, kBelow));
    EXPECT_THAT(answer(kAbove, kAbove).selected, ElementsAre(0, 1, 2));
  }
}

TEST(Ransac, FindsTheMotionOfTheMajority) {
  // Rows 0, 2, 4, 5 make a quarter turn about z and move up by 7; rows 1 and 3 go astray.
  const CorrespondenceSet matches =
      table_of_points({{0, 0, 0}, {5, 5, 5}, {40, 0, 0}, {9, 9, 9}, {0, 30, 0}, {0, 0, 20}},
                      {{0, 0, 7}, {90, 5, 5}, {0, 40, 7}, {9, -80, 9}, {-30, 0, 7}, {0, 0, 27}});
  const GroupingResult result = group_by_ransac(matches);
  EXPECT_THAT(result.selected, ElementsAre(0, 2, 4, 5));
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  ASSERT_TRUE(result.target_from_source.has_value());
  EXPECT_TRUE(result.target_from_source->rotation.isApprox(turn, 1e-9));
  EXPECT_TRUE(result.target_from_source->translation.isApprox(Eigen::Vector3d(0, 0, 7), 1e-9));
}

TEST(Ransac, MirroredTargetGetsAProperRotation) {
  CorrespondenceSet matches = testing::full_table(12);
  matches.target_points = matches.source_points;
  matches.target_points.col(2) *= -1;
  const GroupingResult result = group_by_ransac(matches);
  ASSERT_TRUE(result.target_from_source.has_value());
  EXPECT_TRUE(is_rotation(result.target_from_source->rotation, 1e-9));
}

TEST(Ransac, PoseIsThatOfATripleAndSelectsWhatAgreesWithIt) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const CorrespondenceSet matches = testing::synthetic(8, 1.0, seed).matches;
    const GroupingResult result = group_by_ransac(matches);
    ASSERT_TRUE(result.target_from_source.has_value());
    const RigidTransform pose = *result.target_from_source;
    bool of_a_triple = false;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < a; ++b)
        for (int c = 0; c < b; ++c) {
          const auto fitted = fit_rigid_transform(matches, {c, b, a});
          of_a_triple = of_a_triple || (fitted && fitted->rotation.isApprox(pose.rotation, 1e-12) &&
                                        fitted->translation.isApprox(pose.translation, 1e-12));
        }
    EXPECT_TRUE(of_a_triple);
    Indices agreeing;
    for (int row = 0; row < 8; ++row)
      if ((pose * matches.source_points.row(row).transpose() - matches.target_points.row(row).transpose()).norm() < 5)
        agreeing.push_back(row);
    EXPECT_EQ(result.selected, agreeing);
  }
}

TEST(Ransac, FirstTripleWithTheLargestCountStays) {
  // Every triple of an exactly moved set agrees with all rows: further iterations must not change the pose. The noise
  // is far below the tolerance but tells the triples apart.
  SyntheticOptions problem;
  problem.matches = 10;
  problem.inlier_ratio = 1;
  problem.noise_pr = 1e-4;
  const CorrespondenceSet matches = make_synthetic_problem(problem).matches;
  const GroupingResult first = group_by_ransac(matches, options_of(5, 1));
  ASSERT_EQ(first.selected.size(), 10U);
  for (const int iterations : {2, 10, 100}) {
    const GroupingResult later = group_by_ransac(matches, options_of(5, iterations));
    EXPECT_EQ(later.target_from_source->rotation, first.target_from_source->rotation);
  }
}

TEST(Ransac, MoreIterationsNeverFindLess) {
  const CorrespondenceSet matches = testing::synthetic(60, 0.2, 9).matches;
  std::size_t before = 0;
  for (const int iterations : {1, 3, 10, 30, 100, 300, 1000, 3000}) {
    const std::size_t found = group_by_ransac(matches, options_of(5, iterations)).selected.size();
    EXPECT_GE(found, before) << iterations;
    before = found;
  }
  EXPECT_GE(before, 12U);
}

TEST(Ransac, SeedChoosesTheTriples) {
  const CorrespondenceSet matches = testing::synthetic(100, 0.1, 4).matches;
  RansacOptions one = options_of(5, 50), other = one;
  other.seed = 2;
  EXPECT_EQ(group_by_ransac(matches, one).selected, group_by_ransac(matches, one).selected);
  EXPECT_NE(group_by_ransac(matches, one).selected, group_by_ransac(matches, other).selected);
}

TEST(Ransac, OptionsOutOfRangeAreNamed) {
  const CorrespondenceSet matches = raised_triangle();
  EXPECT_THAT(refusal_of([&] { group_by_ransac(matches, options_of(0)); }), HasSubstr("tolerance_pr"));
  EXPECT_THAT(refusal_of([&] { group_by_ransac(matches, options_of(std::nan(""))); }), HasSubstr("tolerance_pr"));
  EXPECT_THAT(refusal_of([&] { group_by_ransac(matches, options_of(5, 0)); }), HasSubstr("iterations"));
}

/// The first number of iterations after which a triple of correct matches had the required probability.
int iterations_until_confident(const CorrespondenceSet& matches, double confidence, RansacOptions options) {
  for (int iterations = 1;; ++iterations) {
    options.iterations = iterations;
    const double share = static_cast<double>(group_by_ransac(matches, options).selected.size()) / matches.size();
    if (std::pow(1 - share * share * share, iterations) <= 1 - confidence) return iterations;
  }
}

TEST(Ransac, ConfidenceStopsTheSearchAndNothingElse) {
  for (const std::uint64_t seed : {1, 2, 3})
    for (const double confidence : {0.3, 0.9, 0.999}) {
      const CorrespondenceSet matches = testing::synthetic(150, 0.5, seed).matches;
      RansacOptions options;
      options.seed = seed;
      RansacOptions shorter = options;
      shorter.iterations = iterations_until_confident(matches, confidence, options);
      EXPECT_LT(shorter.iterations, 500);
      options.confidence = confidence;
      const GroupingResult found = group_by_ransac(matches, options), expected = group_by_ransac(matches, shorter);
      EXPECT_EQ(found.selected, expected.selected);
      EXPECT_EQ(found.target_from_source->rotation, expected.target_from_source->rotation);
    }
}

TEST(Ransac, NoConfidenceIsEnoughForTheWholeSearch) {
  const CorrespondenceSet matches = testing::synthetic(150, 0.3, 5).matches;
  RansacOptions options;
  options.iterations = 2000;
  const Indices all = group_by_ransac(matches, options).selected;
  options.confidence = 1;
  EXPECT_EQ(group_by_ransac(matches, options).selected, all);
}

RansacOptions parsed(const OptionOverrides& overrides) { return parse_options<RansacOptions>(overrides, "ransac"); }

double score_of(const CorrespondenceSet& matches, PoseScore score, const GroupingResult& result) {
  std::vector<double> residuals;
  measure_residuals(matches, result.target_from_source.value(), residuals);
  return PoseScorer(matches, score, 5 * matches.resolution)(residuals);
}

TEST(Ransac, TheScoreThatIsAskedForIsTheLargest) {
  const std::vector<std::string> scores = {"inliers", "mae", "mse", "msac", "oamae"};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const CorrespondenceSet matches = testing::synthetic(150, 0.2, seed).matches;
    std::vector<GroupingResult> found;
    for (const std::string& score : scores)
      found.push_back(group_by_ransac(matches, parsed({{"score", score}, {"iterations", "2000"}})));
    for (std::size_t i = 0; i < scores.size(); ++i)
      for (const GroupingResult& other : found)
        EXPECT_GE(score_of(matches, static_cast<PoseScore>(i), found[i]),
                  score_of(matches, static_cast<PoseScore>(i), other));
  }
}

TEST(Ransac, LocalRoundsDoNotLowerTheScore) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const CorrespondenceSet matches = testing::synthetic(200, 0.15, seed).matches;
    const OptionOverrides plain = {{"score", "mae"}, {"iterations", "1000"}};
    OptionOverrides local = plain;
    local["local_rounds"] = "10";
    EXPECT_GE(score_of(matches, PoseScore::Mae, group_by_ransac(matches, parsed(local))),
              score_of(matches, PoseScore::Mae, group_by_ransac(matches, parsed(plain))));
  }
}

/// Rows 0 to 2 are carried rigidly, the edges between them and row 3 are in the ratio 0.5 at best.
TEST(Ransac, TriplesWithAnEdgeThatChangesAreDropped) {
  const CorrespondenceSet matches = table_of_points({{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {5, 5, 1}},
                                                    {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {40, 40, 40}});
  EXPECT_THAT(group_by_ransac(matches, parsed({{"edge_similarity", "0.9"}})).selected, ElementsAre(0, 1, 2));
  CorrespondenceSet stretched = matches;
  stretched.target_points *= 0.85;
  EXPECT_THAT(group_by_ransac(stretched, parsed({{"edge_similarity", "0.9"}})).selected, IsEmpty());
  EXPECT_THAT(group_by_ransac(stretched, parsed({{"edge_similarity", "0.8"}})).selected, ElementsAre(0, 1, 2));
}

TEST(Ransac, DistinctiveMatchesFirstNeedFewerTriples) {
  const SyntheticProblem problem = testing::synthetic(1000, 0.1, 3);
  const OptionOverrides few = {{"iterations", "200"}};
  OptionOverrides progressive = few;
  progressive["sampling"] = "prosac";
  int uniform_found = 0, progressive_found = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    OptionOverrides a = few, b = progressive;
    a["seed"] = b["seed"] = std::to_string(seed);
    uniform_found += group_by_ransac(problem.matches, parsed(a)).selected.size() > 80;
    progressive_found += group_by_ransac(problem.matches, parsed(b)).selected.size() > 80;
  }
  EXPECT_GT(progressive_found, uniform_found);
  CorrespondenceSet without = problem.matches;
  without.second_feature_distance.resize(0);
  EXPECT_THAT(refusal_of([&] { group_by_ransac(without, parsed(progressive)); }), HasSubstr("second_feature_distance"));
}

TEST(Ransac, KeptPosesDoNotChangeTheChoice) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CorrespondenceSet matches = testing::harsh_table(120, 0.1, seed);
    const GroupingResult alone = group_by_ransac(matches, parsed({{"iterations", "500"}})),
                         kept = group_by_ransac(matches, parsed({{"iterations", "500"}, {"keep", "4"}}));
    EXPECT_EQ(kept.selected, alone.selected);
    EXPECT_EQ(kept.runner_up.size(), 4U);
    for (std::size_t i = 0; i < kept.runner_up.size(); ++i) {
      EXPECT_LE(kept.runner_up[i].score, static_cast<double>(kept.selected.size()));
      if (i > 0) {
        EXPECT_LE(kept.runner_up[i].score, kept.runner_up[i - 1].score);
      }
    }
  }
}

}  // namespace
}  // namespace corral
