// SPDX-License-Identifier: MIT
#include "grouping/clique.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/evaluation.h"
#include "tests/support/reference/clique.h"
#include "tests/support/same_result.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::table_of_points;

std::int64_t note(const GroupingResult& result, const std::string& name) {
  for (const Note& each : result.notes)
    if (each.name == name) return each.count;
  return -1;
}

/// Four corners that stay and one row that goes astray.
CorrespondenceSet corners() {
  return table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {20, 20, 0}},
                         {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {100, 100, 100}});
}

TEST(Clique, FourCornersAreOneClique) {
  for (const auto structure : {DenseStructure::Clique, DenseStructure::Core}) {
    CliqueOptions options;
    options.structure = structure;
    const GroupingResult result = group_by_clique(corners(), options);
    EXPECT_THAT(result.selected, ElementsAre(0, 1, 2, 3));
    ASSERT_TRUE(result.target_from_source);
    EXPECT_TRUE(result.target_from_source->rotation.isIdentity(1e-12));
    EXPECT_TRUE(result.scores.empty());
  }
  EXPECT_EQ(note(group_by_clique(corners()), "equal_cliques"), 1);
}

/// Three rows stay and three are moved up by 60; one of the two sets does not keep its distances exactly.
TEST(Clique, OfEqualCliquesTheTightestIsTaken) {
  for (const int loose : {1, 4}) {
    CorrespondenceSet matches =
        table_of_points({{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {50, 50, 0}, {80, 50, 0}, {50, 80, 0}},
                        {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {50, 50, 60}, {80, 50, 60}, {50, 80, 60}});
    matches.target_points(loose, 0) += 1;
    const GroupingResult result = group_by_clique(matches);
    EXPECT_EQ(note(result, "equal_cliques"), 2);
    EXPECT_EQ(result.selected, loose == 1 ? Indices({3, 4, 5}) : Indices({0, 1, 2}));
  }
}

TEST(Clique, RowsThatShareAPointAreNotConnected) {
  // Row 4 is the first corner again with another target, 2 away: it keeps all distances within 3.
  CorrespondenceSet matches = corners();
  matches.source_points.row(4).setZero();
  matches.target_points.row(4) = Eigen::RowVector3d(1, 1, 1);
  EXPECT_EQ(note(group_by_clique(matches), "equal_cliques"), 2);
  CliqueOptions shared;
  shared.distinct = false;
  EXPECT_EQ(note(group_by_clique(matches, shared), "equal_cliques"), 1);
  matches.source_points.row(4).swap(matches.target_points.row(4));
  matches.target_points.row(4).setZero();
  EXPECT_EQ(note(group_by_clique(matches), "equal_cliques"), 2);
}

/// Rows that share points agree only without `distinct`; the reference does not bound its search.
TEST(Clique, SharedPointsAreThoseOfTheReference) {
  CliqueOptions shared;
  shared.distinct = false;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double inlier_ratio : {0.05, 0.3}) {
      const CorrespondenceSet matches = testing::harsh_table(150, inlier_ratio, seed);
      EXPECT_EQ(group_by_clique(matches, shared).selected, reference::clique(matches, shared).rows);
    }
}

TEST(Clique, LargerTablesAreThoseOfTheReference) {
  for (const int rows : {250, 500})
    for (const double inlier_ratio : {0.02, 0.1, 0.3}) {
      const CorrespondenceSet matches = testing::harsh_table(rows, inlier_ratio, 4);
      testing::expect_reference(group_by_clique(matches), reference::clique(matches, {}));
    }
}

/// Beside four corners that stay lie four rows of a square and two above and below it; opposite ones do not fit.
TEST(Clique, CoreIsAnotherStructure) {
  CorrespondenceSet matches = table_of_points({{0, 0, 0},
                                               {20, 0, 0},
                                               {0, 20, 0},
                                               {0, 0, 20},
                                               {500, 0, 0},
                                               {540, 0, 0},
                                               {520, 20, 0},
                                               {520, -20, 0},
                                               {520, 0, 20},
                                               {520, 0, -20}},
                                              {{0, 0, 0},
                                               {20, 0, 0},
                                               {0, 20, 0},
                                               {0, 0, 20},
                                               {2, 900, 0},
                                               {38, 900, 0},
                                               {20, 918, 0},
                                               {20, 882, 0},
                                               {20, 900, 18},
                                               {20, 900, -18}});
  EXPECT_THAT(group_by_clique(matches).selected, ElementsAre(0, 1, 2, 3));
  CliqueOptions core;
  core.structure = DenseStructure::Core;
  EXPECT_THAT(group_by_clique(matches, core).selected, ElementsAre(4, 5, 6, 7, 8, 9));
}

TEST(Clique, PastTheBoundTheCoreIsUsedAndSaidSo) {
  CliqueOptions whole, core;
  whole.edge_pr = core.edge_pr = 1;  // some of the correct rows do not agree
  core.structure = DenseStructure::Core;
  int bounded = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CorrespondenceSet matches = testing::synthetic(200, 0.9, seed).matches;
    const GroupingResult unbounded = group_by_clique(matches, whole);
    EXPECT_EQ(note(unbounded, "core_instead"), -1);
    if (note(unbounded, "steps") < 2) continue;
    ++bounded;
    CliqueOptions less = whole;
    less.max_steps = static_cast<int>(note(unbounded, "steps")) - 1;
    const GroupingResult result = group_by_clique(matches, less);
    EXPECT_EQ(note(result, "core_instead"), 1);
    testing::expect_same_result(result, group_by_clique(matches, core));
  }
  EXPECT_GT(bounded, 5);
}

TEST(Clique, ComparisonOfEqualsIsBoundedAndSaidSo) {
  // Copies of a corner nearby: any one of twelve of each of four belongs to a largest clique.
  CorrespondenceSet matches = corners();
  Indices rows;
  for (int row = 0; row < 48; ++row) rows.push_back(row / 12);
  matches = select_rows(matches, rows);
  for (int row = 0; row < 48; ++row) {
    const Eigen::RowVector3d place = matches.source_points.row(row);
    matches.source_points.row(row) = 1.001 * place + Eigen::RowVector3d(0, 0, 0.01 * (row % 12));
    matches.target_points.row(row) = place - Eigen::RowVector3d(0, 0, 3.5 * (row % 12));
  }
  CliqueOptions options;
  options.max_steps = 1000;
  const GroupingResult result = group_by_clique(matches, options);
  EXPECT_EQ(note(result, "comparison_left"), 1);
  EXPECT_GE(result.selected.size(), 4U);
}

TEST(Clique, FindsFewCorrectRowsAmongMany) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SyntheticProblem problem = testing::synthetic(1000, 0.02, seed);
    const GroupingResult result = group_by_clique(problem.matches);
    ASSERT_TRUE(result.target_from_source);
    EXPECT_LT(rotation_error_deg(*result.target_from_source, problem.truth), 3) << "seed " << seed;
  }
}

TEST(Clique, NothingToFindGivesNothing) {
  for (const auto& matches : {table_of_points({{0, 0, 0}, {9, 0, 0}}, {{0, 0, 0}, {9, 0, 0}}),
                              testing::table_on_line({0, 10, 25, 60}, {0, 100, 10, 500}),
                              testing::table_on_line({0, 10, 25, 60}, {0, 10, 25, 60})}) {
    const GroupingResult result = group_by_clique(matches);
    EXPECT_THAT(result.selected, IsEmpty());
    EXPECT_FALSE(result.target_from_source);
  }
}

}  // namespace
}  // namespace corral
