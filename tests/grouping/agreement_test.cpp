// SPDX-License-Identifier: MIT
// Every grouper against a slow one written from its definition, on random tables of several hundred rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "grouping/ransac.h"
#include "tests/support/reference/frame_ransac.h"
#include "tests/support/reference/groupers.h"
#include "tests/support/reference/sc2pcr.h"
#include "tests/support/reference/turboreg.h"
#include "tests/support/same_result.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::harsh_table;
using testing::synthetic;

struct NamedTable {
  std::string name;
  CorrespondenceSet matches;
};

NamedTable named_table(const std::string& kind, int matches, double inlier_ratio, std::uint64_t seed) {
  return {kind + " table, " + std::to_string(matches) + " rows, inlier ratio " + std::to_string(inlier_ratio) +
              ", seed " + std::to_string(seed),
          kind == "harsh" ? harsh_table(matches, inlier_ratio, seed) : synthetic(matches, inlier_ratio, seed).matches};
}

/// Both kinds, three inlier ratios, as many seeds as asked for.
std::vector<NamedTable> tables(const std::vector<int>& sizes, std::uint64_t seeds) {
  std::vector<NamedTable> all;
  for (const std::string kind : {"smooth", "harsh"})
    for (const int size : sizes)
      for (const double ratio : {0.05, 0.2, 0.5})
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) all.push_back(named_table(kind, size, ratio, seed));
  return all;
}

template <class Options>
void expect_identical(GroupingResult (*group)(const CorrespondenceSet&, const Options&),
                      reference::Selection (*reference)(const CorrespondenceSet&, const Options&),
                      const Options& options, const std::vector<NamedTable>& on) {
  std::size_t selected = 0;
  for (const auto& [name, matches] : on) {
    SCOPED_TRACE(name);
    const reference::Selection expected = reference(matches, options);
    testing::expect_reference(group(matches, options), expected);
    selected += expected.rows.size();
  }
  EXPECT_GT(selected, 0U) << "nothing was selected on any table: nothing was compared";
}

TEST(Agreement, SimilarityScore) {
  for (const OtsuRule rule : {OtsuRule::Exact, OtsuRule::Bins100, OtsuRule::Covis}) {
    SCOPED_TRACE("otsu rule " + std::to_string(static_cast<int>(rule)));
    expect_identical(group_by_similarity_score, reference::similarity_score, {rule}, tables({250, 500, 1000}, 4));
  }
}

TEST(Agreement, NearestNeighborRatio) {
  for (const RatioRule rule : {RatioRule::Lowe, RatioRule::Literal}) {
    for (const double threshold : {0.0, 0.5, 0.8, 1.0}) {
      if (rule == RatioRule::Literal && threshold > 0.5) continue;  // hardly anything passes
      if (rule == RatioRule::Lowe && threshold == 0) continue;      // nothing passes
      SCOPED_TRACE("threshold " + std::to_string(threshold) + ", rule " + std::to_string(static_cast<int>(rule)));
      NearestNeighborRatioOptions options;
      options.threshold = threshold;
      options.ratio = rule;
      expect_identical(group_by_nearest_neighbor_ratio, reference::nearest_neighbor_ratio, options,
                       tables({250, 500, 1000}, 4));
    }
  }
}

TEST(Agreement, GeometricConsistency) {
  for (const ClusterRule rule : {ClusterRule::Star, ClusterRule::Clique}) {
    SCOPED_TRACE("cluster rule " + std::to_string(static_cast<int>(rule)));
    GeometricConsistencyOptions options;
    options.cluster = rule;
    expect_identical(group_by_geometric_consistency, reference::geometric_consistency, options,
                     tables({250, 500, 1000}, 3));
    options.tolerance_pr = 12;
    expect_identical(group_by_geometric_consistency, reference::geometric_consistency, options, tables({250}, 3));
  }
}

TEST(Agreement, HoughVoting) {
  for (const HoughCells cells : {HoughCells::Box, HoughCells::Pr5}) {
    SCOPED_TRACE("cells " + std::to_string(static_cast<int>(cells)));
    HoughVotingOptions options;
    options.cells = cells;
    expect_identical(group_by_hough_voting, reference::hough_voting, options, tables({250, 500, 1000}, 4));
    options.bins = 4;
    expect_identical(group_by_hough_voting, reference::hough_voting, options, tables({250}, 3));
  }
}

TEST(Agreement, HoughVotingWithoutCentroid) {
  std::vector<NamedTable> on = tables({250}, 3);
  for (auto& table : on) {
    table.matches.source_points.rowwise() += Eigen::RowVector3d(40, -20, 75);  // else the mean is nearly the origin
    table.matches.source_centroid.reset();
  }
  expect_identical(group_by_hough_voting, reference::hough_voting, {}, on);
}

TEST(Agreement, SearchOfInliers) {
  for (const VotingForm form : {VotingForm::Paper, VotingForm::Covis, VotingForm::Rotation}) {
    for (const OtsuRule rule : {OtsuRule::Exact, OtsuRule::Bins100, OtsuRule::Covis}) {
      SCOPED_TRACE("form " + std::to_string(static_cast<int>(form)) + ", otsu " +
                   std::to_string(static_cast<int>(rule)));
      SearchOfInliersOptions options;
      options.form = form;
      options.otsu = rule;
      expect_identical(group_by_search_of_inliers, reference::search_of_inliers, options, tables({250, 500}, 2));
      options.voters = 20;
      options.similarity = 0.8;
      expect_identical(group_by_search_of_inliers, reference::search_of_inliers, options, tables({250, 500}, 1));
    }
  }
}

TEST(Agreement, SearchOfInliersOnThousandRows) {
  expect_identical(group_by_search_of_inliers, reference::search_of_inliers, {}, tables({1000}, 1));
}

TEST(Agreement, SpectralIterative) {
  expect_identical(group_by_spectral, reference::spectral, {}, tables({60, 120}, 3));
}

TEST(Agreement, SpectralIterativeStricter) {
  SpectralOptions options;
  options.similarity = 0.9;
  expect_identical(group_by_spectral, reference::spectral, options, tables({60, 250}, 2));
}

TEST(Agreement, SpectralOnce) {
  SpectralOptions options;
  options.once = true;
  expect_identical(group_by_spectral, reference::spectral, options, tables({60, 250}, 2));
}

TEST(Agreement, SpectralWeighted) {
  SpectralOptions options;
  options.weighted = true;
  expect_identical(group_by_spectral, reference::spectral, options, tables({60, 120}, 3));
  options.once = true;
  expect_identical(group_by_spectral, reference::spectral, options, tables({250}, 1));
}

TEST(Agreement, SpectralOnLargerTables) {
  expect_identical(group_by_spectral, reference::spectral, {},
                   {named_table("smooth", 250, 0.2, 1), named_table("harsh", 250, 0.2, 1)});
}

/// The reference draws the same triples, so that the first of the best must be the same one.
TEST(Agreement, RansacOnTheSameTriples) {
  for (const std::uint64_t seed : {1, 2, 77}) {
    SCOPED_TRACE("seed of the triples " + std::to_string(seed));
    RansacOptions options;
    options.seed = seed;
    options.iterations = 2000;
    expect_identical(group_by_ransac, reference::ransac, options, tables({60, 150, 300}, 1));
    options.iterations = 300;
    expect_identical(group_by_ransac, reference::ransac, options, tables({3, 4, 5, 8, 13, 21}, 8));
    options.tolerance_pr = 0.5;
    expect_identical(group_by_ransac, reference::ransac, options, tables({5, 30, 100}, 4));
  }
}

/// Two hundred tables, of shares from 1 to 95 % and with noise up to the tolerance: matches that cannot take part in a better
/// pose are left out, triples that cannot win are not fitted, and the search may end before its last triple.
TEST(Agreement, RansacLeavesOutWhatCannotWin) {
  const std::vector<int> sizes = {20, 40, 70, 100, 150, 250};
  const std::vector<double> ratios = {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
  std::vector<NamedTable> on;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SyntheticOptions problem;
    problem.matches = sizes[seed % sizes.size()];
    problem.inlier_ratio = ratios[seed / 2 % ratios.size()];
    problem.noise_pr = 0.5 * static_cast<double>(seed % 7);
    problem.seed = seed;
    const CorrespondenceSet matches = make_synthetic_problem(problem).matches;
    on.push_back({"table " + std::to_string(seed), seed % 3 == 0 ? testing::made_harsh(matches) : matches});
  }
  RansacOptions options;
  options.iterations = 1500;
  expect_identical(group_by_ransac, reference::ransac, options, on);
  options.iterations = 6000;
  expect_identical(group_by_ransac, reference::ransac, options, {named_table("smooth", 1000, 0.4, 1)});
}

/// The areas of the triangles straddle the smallest usable one, on the two sides independently.
TEST(Agreement, RansacOnSmallTriangles) {
  RansacOptions options;
  options.iterations = 300;
  options.tolerance_pr = 0.005;
  std::vector<NamedTable> on = tables({10, 50}, 20);
  for (auto& table : on) {
    table.matches.resolution = 1000;  // the side of the cube is 0.2 pr
    table.matches.target_points.col(2) *= 0.5;
  }
  expect_identical(group_by_ransac, reference::ransac, options, on);
}

/// A needle of 200 x 0.2 x 0.2 pr: the second singular value straddles 1e-6 of the first.
CorrespondenceSet needle(std::uint64_t seed) {
  const SyntheticProblem problem = synthetic(40, 0.7, seed);
  const Eigen::Matrix3d thin = Eigen::Vector3d(1, 1e-3, 1e-3).asDiagonal();
  CorrespondenceSet matches = problem.matches;
  matches.source_points = (matches.source_points * thin).eval();
  matches.target_points = problem.truth.apply(problem.truth.inverse().apply(matches.target_points) * thin);
  return matches;
}

TEST(Agreement, RansacOnThinTriangles) {
  RansacOptions options;
  options.iterations = 30;
  std::vector<NamedTable> on;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) on.push_back({"needle " + std::to_string(seed), needle(seed)});
  for (const double tolerance : {0.5, 5.0}) {
    options.tolerance_pr = tolerance;
    expect_identical(group_by_ransac, reference::ransac, options, on);
  }
}

TEST(Agreement, RansacFindsAsManyInliers) {
  for (const auto& [name, matches] :
       {named_table("smooth", 250, 0.2, 1), named_table("harsh", 250, 0.5, 2), named_table("smooth", 500, 0.1, 3)}) {
    SCOPED_TRACE(name);
    RansacOptions options;
    double found = 0, expected = 0;
    constexpr int kRuns = 4;
    for (int run = 1; run <= kRuns; ++run) {
      options.seed = static_cast<std::uint64_t>(run);
      found += static_cast<double>(group_by_ransac(matches, options).selected.size()) / kRuns;
      expected +=
          reference::ransac_count(matches, options.iterations, options.tolerance_pr, options.seed) / (kRuns * 1.0);
    }
    // Both are averages of a random count; the best of 10000 triples scatters by a few percent.
    EXPECT_GT(found, 0.95 * expected - 1);
    EXPECT_LT(found, 1.05 * expected + 1);
  }
}

TEST(Agreement, Turboreg) {
  TurboregOptions options;
  expect_identical(group_by_turboreg, reference::turboreg, options, tables({60, 250}, 3));
  expect_identical(group_by_turboreg, reference::turboreg, options, tables({500}, 1));
  options.score = PoseScore::Msac;
  options.refit_rounds = 0;
  for (const int pivots : {1, 10, 100}) {
    options.pivots = pivots;
    expect_identical(group_by_turboreg, reference::turboreg, options, tables({50, 120, 300}, 2));
  }
}

TEST(Agreement, Sc2pcr) {
  Sc2pcrOptions options;
  expect_identical(group_by_sc2pcr, reference::sc2pcr, options, tables({60, 250}, 3));
  expect_identical(group_by_sc2pcr, reference::sc2pcr, options, tables({500}, 1));
  options.score = PoseScore::Mae;
  options.refit_rounds = 0;
  options.seed_share = 1;
  for (const int neighbours : {3, 10, 1000}) {
    options.neighbours = neighbours;
    options.kept = neighbours == 1000 ? 100 : 5;
    expect_identical(group_by_sc2pcr, reference::sc2pcr, options, tables({50, 120, 200}, 2));
  }
}

TEST(Agreement, FrameRansac) {
  FrameRansacOptions options;
  expect_identical(group_by_frame_ransac, reference::frame_ransac, options, tables({60, 250}, 3));
  expect_identical(group_by_frame_ransac, reference::frame_ransac, options, tables({500}, 1));
  for (const PoseScore score : {PoseScore::Mae, PoseScore::Oamae})
    for (const int polish : {0, 1, 10}) {
      options.score = score;
      options.polish = polish;
      expect_identical(group_by_frame_ransac, reference::frame_ransac, options, tables({50, 120, 300}, 2));
    }
}

}  // namespace
}  // namespace corral
