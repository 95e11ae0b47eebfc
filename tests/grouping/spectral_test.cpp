// SPDX-License-Identifier: MIT
#include "grouping/spectral.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using testing::table_on_line;

SpectralOptions once() {
  SpectralOptions options;
  options.once = true;
  return options;
}

SpectralOptions weighted() {
  SpectralOptions options;
  options.weighted = true;
  return options;
}

TEST(Spectral, LimitIsIncluded) {
  // r = 3/5, and a little less.
  EXPECT_THAT(group_by_spectral(table_on_line({0, 3}, {0, 5})).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_spectral(table_on_line({0, 3}, {0, 5.001})).selected, IsEmpty());
  EXPECT_THAT(group_by_spectral(table_on_line({0, 5}, {0, 3})).selected, ElementsAre(0, 1));
}

TEST(Spectral, SimilarityIsAnOption) {
  SpectralOptions options;
  options.similarity = 0.61;
  EXPECT_THAT(group_by_spectral(table_on_line({0, 3}, {0, 5}), options).selected, IsEmpty());
  for (const double bad : {0.0, -0.5, 1.1, std::nan("")}) {
    options.similarity = bad;
    EXPECT_THAT(refusal_of([&] {
                  group_by_spectral(table_on_line({0, 3}, {0, 5}), options);
                }),
                HasSubstr("similarity"));
  }
}

TEST(Spectral, NoCompatiblePairGivesNothing) {
  EXPECT_THAT(group_by_spectral(table_on_line({4}, {7})).selected, IsEmpty());
  EXPECT_THAT(group_by_spectral(table_on_line({0, 10, 20}, {0, 100, 900})).selected, IsEmpty());
  EXPECT_THAT(group_by_spectral(table_on_line({0, 10, 20}, {0, 100, 900}), once()).selected, IsEmpty());
  // Coinciding rows have r = 0: no two are compatible.
  EXPECT_THAT(group_by_spectral(table_on_line({1, 1, 1}, {2, 2, 2})).selected, IsEmpty());
  EXPECT_THAT(group_by_spectral(table_on_line({1, 1, 1}, {2, 12, 22})).selected, IsEmpty());
}

// Compatible pairs 1-2, 1-3, 2-3 (r = 1) and 0-1 (r = 10/10); r(0,2) = 6/14, r(0,3) = 3/17.
CorrespondenceSet triangle_with_a_tail() { return table_on_line({10, 0, 4, 7}, {-10, 0, 4, 7}); }

TEST(Spectral, KeepsTheTriangleAndDropsTheTail) {
  // Row 1 has most neighbours and the largest entry. It is in conflict with nobody. Of rows 0, 2 and 3 the pair 2-3 is
  // the heaviest part: row 2, which removes row 0; row 3 is left.
  for (const SpectralOptions& options : {SpectralOptions(), once(), weighted()}) {
    const GroupingResult result = group_by_spectral(triangle_with_a_tail(), options);
    EXPECT_THAT(result.selected, ElementsAre(1, 2, 3));
    EXPECT_THAT(result.scores, IsEmpty());
    EXPECT_FALSE(result.target_from_source.has_value());
  }
}

TEST(Spectral, HeaviestPartFirst) {
  // A pair {0,1} and a triple {2,3,4} far away, r across at most 1000/3000.
  const CorrespondenceSet matches = table_on_line({0, 10, 1000, 1010, 1030}, {0, 10, 5000, 5010, 5030});
  EXPECT_THAT(group_by_spectral(matches).selected, ElementsAre(2, 3, 4));
  EXPECT_THAT(group_by_spectral(matches, once()).selected, ElementsAre(2, 3, 4));
}

TEST(Spectral, EquallyHeavyPartsTheLowestRowFirst) {
  // Pairs {0,2} and {1,3}; then {1,2} and {0,3}.
  EXPECT_THAT(group_by_spectral(table_on_line({0, 1000, 10, 1010}, {0, 5000, 10, 5010})).selected, ElementsAre(0, 2));
  EXPECT_THAT(group_by_spectral(table_on_line({1000, 0, 10, 1010}, {5000, 0, 10, 5010})).selected, ElementsAre(0, 3));
}

TEST(Spectral, EqualEntriesTheLowestRowFirst) {
  // A path 1 - 0 - 2: r(0,1) = r(0,2) = 3/5, and rows 1 and 2 share a target, r = 0. Row 0 first; rows 1 and 2 are
  // alike: row 1, which removes row 2.
  EXPECT_THAT(group_by_spectral(table_on_line({3, 0, 6}, {5, 0, 0})).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_spectral(table_on_line({3, 6, 0}, {5, 0, 0})).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_spectral(table_on_line({3, 0, 6}, {5, 0, 0}), once()).selected, ElementsAre(0, 1));
}

TEST(Spectral, OnceDoesNotLookAtTheRestAgain) {
  // Triangles {0,2,5} (r 1, 0.6, 0.67) and {1,3,4} (0.82, 0.78, 1), joined by the pair 2-4 (0.6): mirror images, so
  // entries 2 and 4 are equal and the largest, and the other four are equal. Row 2 is accepted and removes 1 and 3.
  // Left are the pair 0-5 and row 4 alone. A new eigenvector prefers the pair; the old one prefers row 4.
  const CorrespondenceSet matches = table_on_line({13, 15, 4, 6, 24, 10}, {10, 14, 19, 25, 7, 15});
  EXPECT_THAT(group_by_spectral(matches).selected, ElementsAre(0, 2, 5));
  EXPECT_THAT(group_by_spectral(matches, once()).selected, ElementsAre(2, 4));
}

TEST(Spectral, WeightedPrefersStrongPairs) {
  // A path 0 - 1 - 2 with r = 0.6 and a pair {3,4} with r = 1. Eigenvalues: 1 + sqrt 2 against 2 with edges of 1,
  // 1 + 0.6 sqrt 2 = 1.85 against 2 with edges of r. Rows 0 and 2 share a target, so only one of them stays.
  const CorrespondenceSet matches = table_on_line({0, 3, 6, 1000, 1010}, {0, 5, 0, 5000, 5010});
  EXPECT_THAT(group_by_spectral(matches).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_spectral(matches, weighted()).selected, ElementsAre(3, 4));
  SpectralOptions both = weighted();
  both.once = true;
  EXPECT_THAT(group_by_spectral(matches, both).selected, ElementsAre(3, 4));
}

TEST(Spectral, WeightsCountToTheLastDigits) {
  // The path 1 - 0 - 2 again. Row 2 a little farther out: r(0,2) = 0.6 + 6e-9, which no float tells from 0.6. Its entry
  // exceeds that of row 1 by 5e-9, more than a tie.
  SpectralOptions options = weighted();
  options.once = true;
  EXPECT_THAT(group_by_spectral(table_on_line({3, 0, 6}, {5, 0, 0}), options).selected, ElementsAre(0, 1));
  EXPECT_THAT(group_by_spectral(table_on_line({3, 0, 6 + 3e-8}, {5, 0, 0}), options).selected, ElementsAre(0, 2));
}

TEST(Spectral, AcceptedMatchesAreCompatibleWithEachOther) {
  for (const SpectralOptions& options : {SpectralOptions(), once(), weighted()}) {
    const CorrespondenceSet matches = testing::harsh_table(150, 0.3, 8);
    const Indices selected = group_by_spectral(matches, options).selected;
    EXPECT_GT(selected.size(), 20U);
    for (const int i : selected)
      for (const int j : selected) {
        if (i == j) continue;
        const double source = (matches.source_points.row(i) - matches.source_points.row(j)).norm();
        const double target = (matches.target_points.row(i) - matches.target_points.row(j)).norm();
        EXPECT_GE(std::min(source / target, target / source), 0.6) << i << " " << j;
      }
  }
}

TEST(Spectral, OrderOfTheRowsDoesNotMatter) {
  const CorrespondenceSet matches = testing::synthetic(120, 0.3, 6).matches;
  CorrespondenceSet reversed = matches;
  reversed.source_points = matches.source_points.colwise().reverse();
  reversed.target_points = matches.target_points.colwise().reverse();
  Indices expected;
  for (const int row : group_by_spectral(matches).selected) expected.insert(expected.begin(), 119 - row);
  EXPECT_EQ(group_by_spectral(reversed).selected, expected);
}

}  // namespace
}  // namespace corral
