// SPDX-License-Identifier: MIT
#include "apps/dataset/challenge_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/matches/matches_file.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/synthetic.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::HasSubstr;

SyntheticProblem real_problem() {
  SyntheticOptions options;
  options.matches = 300;
  options.inlier_ratio = 0.1;
  return make_synthetic_problem(options);
}

int correct_in(const CorrespondenceSet& matches, const RigidTransform& truth) {
  const std::vector<bool> labels = label_correct(matches, truth, 4);
  return static_cast<int>(std::count(labels.begin(), labels.end(), true));
}

using Point = std::array<double, 3>;
std::set<Point> points_of(const Points& points) {
  std::set<Point> set;
  for (Eigen::Index i = 0; i < points.rows(); ++i) set.insert({points(i, 0), points(i, 1), points(i, 2)});
  return set;
}

TEST(ChallengeTable, HasTheSizeAndTheShareThatWereAskedFor) {
  const SyntheticProblem real = real_problem();
  for (const int matches : {1, 30, 1000, 20000})
    for (const double ratio : {0.0, 0.5, 10.0, 50.0, 100.0})
      for (const double noise : {0.0, 0.5}) {
        const CorrespondenceSet drawn = draw_challenge(real.matches, real.truth, {matches, ratio, noise, 4, 7});
        drawn.validate();
        EXPECT_EQ(drawn.size(), matches);
        EXPECT_EQ(correct_in(drawn, real.truth), std::llround(matches * ratio / 100)) << matches << " " << ratio;
        EXPECT_EQ(drawn.resolution, real.matches.resolution);
      }
}

TEST(ChallengeTable, KeepsRealRowsWhileThereAreAny) {
  const SyntheticProblem real = real_problem();
  std::set<std::pair<Point, Point>> rows;
  const auto row_of = [](const CorrespondenceSet& matches, Eigen::Index i) {
    const auto& p = matches.source_points;
    const auto& q = matches.target_points;
    return std::pair(Point{p(i, 0), p(i, 1), p(i, 2)}, Point{q(i, 0), q(i, 1), q(i, 2)});
  };
  for (Eigen::Index i = 0; i < real.matches.size(); ++i) rows.insert(row_of(real.matches, i));
  const CorrespondenceSet drawn = draw_challenge(real.matches, real.truth, {100, 10, 0, 4, 3});
  std::set<std::pair<Point, Point>> seen;
  for (Eigen::Index i = 0; i < drawn.size(); ++i) {
    EXPECT_TRUE(rows.count(row_of(drawn, i))) << "row " << i;
    EXPECT_TRUE(seen.insert(row_of(drawn, i)).second) << "each once";
  }
}

TEST(ChallengeTable, IncorrectRowsThatArePairedAnewKeepTheirEndPoints) {
  const SyntheticProblem real = real_problem();
  const CorrespondenceSet drawn = draw_challenge(real.matches, real.truth, {5000, 0, 0, 4, 3});
  const auto sources = points_of(real.matches.source_points), targets = points_of(real.matches.target_points);
  for (const Point& point : points_of(drawn.source_points)) EXPECT_TRUE(sources.count(point));
  for (const Point& point : points_of(drawn.target_points)) EXPECT_TRUE(targets.count(point));
}

TEST(ChallengeTable, CorrectRowsThatAreMadeKeepTheResidualsOfRealOnes) {
  const SyntheticProblem real = real_problem();
  const CorrespondenceSet drawn = draw_challenge(real.matches, real.truth, {3000, 100, 0, 4, 3});
  const auto residuals = [&](const CorrespondenceSet& matches) {
    const Points images = real.truth.apply(matches.source_points);
    std::vector<double> values;
    for (Eigen::Index i = 0; i < images.rows(); ++i)
      values.push_back((images.row(i) - matches.target_points.row(i)).norm());
    return values;
  };
  std::vector<double> known = residuals(real.matches);
  for (const double residual : residuals(drawn)) {
    const double nearest = *std::min_element(known.begin(), known.end(), [&](double a, double b) {
      return std::abs(a - residual) < std::abs(b - residual);
    });
    EXPECT_NEAR(residual, nearest, 1e-9);
  }
  EXPECT_GT(points_of(drawn.source_points).size(), 2900u) << "matches of their own, not copies";
}

TEST(ChallengeTable, IsTheSameForTheSameSeedAlone) {
  const SyntheticProblem real = real_problem();
  const ChallengeOptions options{500, 5, 0.3, 4, 11};
  ChallengeOptions other = options;
  other.seed = 12;
  EXPECT_EQ(matches_text(draw_challenge(real.matches, real.truth, options)),
            matches_text(draw_challenge(real.matches, real.truth, options)));
  EXPECT_NE(matches_text(draw_challenge(real.matches, real.truth, options)),
            matches_text(draw_challenge(real.matches, real.truth, other)));
}

TEST(ChallengeTable, RefusesWhatCannotBeDrawn) {
  const SyntheticProblem real = real_problem();
  const auto refuses = [&](const CorrespondenceSet& matches, const ChallengeOptions& options) {
    EXPECT_THROW(draw_challenge(matches, real.truth, options), InvalidInput);
  };
  refuses(real.matches, {0, 10, 0, 4, 1});
  refuses(real.matches, {10, 101, 0, 4, 1});
  refuses(real.matches, {10, std::nan(""), 0, 4, 1});
  refuses(real.matches, {10, 50, -1, 4, 1});
  refuses(real.matches, {1000, 50, 1e9, 4, 1});
  const CorrespondenceSet incorrect = draw_challenge(real.matches, real.truth, {50, 0, 0, 4, 1});
  refuses(incorrect, {10, 50, 0, 4, 1});
  refuses(draw_challenge(real.matches, real.truth, {30, 100, 0, 4, 1}), {10, 50, 0, 4, 1});
}

TEST(MakeChallenge, IsADataSetOfItsTables) {
  const Workplace place;
  const SyntheticProblem real = real_problem();
  std::filesystem::create_directories(place / "real");
  place.put("real/dataset.toml", "name = \"real\"\n");
  place.put("real/pairs.csv", "pair,source,target,truth,matches\np,,,t.txt,m.csv\n");
  place.put("real/m.csv", matches_text(real.matches));
  place.put("real/t.txt", transform_text(real.truth));
  const std::string make = "dataset make challenge --tables real --sizes 100,400 --ratios 5,40 --repeats 2 -o set";
  ASSERT_EQ(place.corral(make).status, 0);
  const std::string pairs = place.text("set/pairs.csv"), table = place.text("set/matches/p-m400-r5-2.csv");
  EXPECT_THAT(pairs, HasSubstr("p-m400-r5-2,,,truth/p.txt,matches/p-m400-r5-2.csv,p,400,5,0,2"));
  EXPECT_EQ(correct_in(read_matches(place / "set/matches/p-m400-r5-2.csv"), real.truth), 20);
  std::filesystem::remove(place / "set/matches/p-m400-r5-2.csv");
  EXPECT_EQ(place.corral(make + " --threads 2").status, 0) << "again";
  EXPECT_EQ(place.text("set/matches/p-m400-r5-2.csv"), table);
  EXPECT_EQ(place.corral("dataset check set").status, 0);
  EXPECT_EQ(place.corral("evaluate inlier-ratio --data set -o study").status, 0);
  EXPECT_THAT(place.text("study/summary.csv"), HasSubstr("inlier-ratio,challenge,\"[5,10)\",gc,4,"));
  RigidTransform elsewhere = real.truth;
  elsewhere.translation.array() += 1e6;
  place.put("real/t.txt", transform_text(elsewhere));
  EXPECT_THAT(place.corral("dataset make challenge --tables real --sizes 100 --ratios 5 -o none").err,
              HasSubstr("pair p: "))
      << "no correct match to draw from";
  place.put("real/pairs.csv", "pair,source,target,truth,matches\np,,,,m.csv\n");
  EXPECT_THAT(place.corral("dataset make challenge --tables real -o other").err,
              HasSubstr("has no table of matches with a truth"));
}

}  // namespace
}  // namespace corral
