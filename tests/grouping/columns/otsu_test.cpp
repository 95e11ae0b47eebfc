// SPDX-License-Identifier: MIT
#include "grouping/columns/otsu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr OtsuRule kRules[] = {OtsuRule::Exact, OtsuRule::Bins100, OtsuRule::Covis};

TEST(Otsu, NoScoresGiveNoRows) {
  for (const OtsuRule rule : kRules) EXPECT_THAT(select_by_otsu({}, rule), IsEmpty());
}

TEST(Otsu, EqualScoresAreAllKept) {
  for (const OtsuRule rule : kRules) {
    EXPECT_THAT(select_by_otsu({0.5}, rule), ElementsAre(0));
    EXPECT_THAT(select_by_otsu({0.25, 0.25, 0.25, 0.25}, rule), ElementsAre(0, 1, 2, 3));
  }
}

TEST(Otsu, NonFiniteScoresAreRefused) {
  for (const OtsuRule rule : kRules)
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      EXPECT_THROW(select_by_otsu({0.1, bad, 0.9}, rule), InvalidInput);
}

TEST(OtsuExact, PartsTwoClassesInAnyOrder) {
  EXPECT_THAT(select_by_otsu({0.9, 0.1, 1.0, 0.2}, OtsuRule::Exact), ElementsAre(0, 2));
}

TEST(OtsuExact, WeighsTheClassesByTheirSizes) {
  // Cut 0 | 3: 4 * 5 * (0 - 19/5)^2 = 288.8. Cut 3 | 7, the widest gap: 8 * 1 * (1.5 - 7)^2 = 242.
  EXPECT_THAT(select_by_otsu({0, 0, 0, 0, 3, 3, 3, 3, 7}, OtsuRule::Exact), ElementsAre(4, 5, 6, 7, 8));
}

TEST(OtsuExact, TieGoesToTheLowestGap) {
  // Cut 0 | 1: 1 * 2 * (0 - 1.5)^2 = 4.5. Cut 1 | 2: 2 * 1 * (0.5 - 2)^2 = 4.5.
  EXPECT_THAT(select_by_otsu({0, 1, 2}, OtsuRule::Exact), ElementsAre(1, 2));
  // Cut 0 | 1: 1 * 3 * (0 - 4/3)^2 = 16/3. Cut 1 | 2: 3 * 1 * (2/3 - 2)^2 = 16/3: in thirds, only rounding differs.
  EXPECT_THAT(select_by_otsu({0, 1, 1, 2}, OtsuRule::Exact), ElementsAre(1, 2, 3));
}

TEST(OtsuExact, EqualScoresStayTogether) {
  // Cut 0 | 1: 1 * 3 * 1 = 3 is the only gap.
  EXPECT_THAT(select_by_otsu({1, 0, 1, 1}, OtsuRule::Exact), ElementsAre(0, 2, 3));
}

TEST(OtsuExact, NeighbouringDoublesArePartedToo) {
  double low = 1;
  for (int i = 0; i < 2; ++i) {  // the midpoint rounds down in one case and up in the other
    const double high = std::nextafter(low, 2.0);
    EXPECT_THAT(select_by_otsu({high, low, high, low}, OtsuRule::Exact), ElementsAre(0, 2));
    low = high;
  }
}

TEST(OtsuExact, FarFromZeroIsAsGoodAsNear) {
  EXPECT_THAT(select_by_otsu({1e9, 1e9 + 1, 1e9 + 10, 1e9 + 11}, OtsuRule::Exact), ElementsAre(2, 3));
  EXPECT_THAT(select_by_otsu({-0.4, -0.3, 0.3, 0.2}, OtsuRule::Exact), ElementsAre(2, 3));
}

// Bins of 0.01 hold 0 | 10, 10 | 90, 99. Cut after bin 10: 3 * 2 * (20/3 - 94.5)^2, far above the other two.
const std::vector<double> kThreeGroups = {0, 0.105, 0.1075, 0.905, 1};

TEST(OtsuBins100, AcceptsTheLastBinOfTheLowerClass) {
  EXPECT_THAT(select_by_otsu(kThreeGroups, OtsuRule::Bins100), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(select_by_otsu(kThreeGroups, OtsuRule::Exact), ElementsAre(3, 4));
}

TEST(OtsuBins100, BinsStartAtTheSmallestScore) {
  for (const double shift : {-5.0, 0.25, 7.0}) {
    std::vector<double> shifted = kThreeGroups;
    for (double& score : shifted) score += shift;
    EXPECT_THAT(select_by_otsu(shifted, OtsuRule::Bins100), ElementsAre(1, 2, 3, 4));
  }
}

TEST(OtsuBins100, BinsSpanTheRangeOfTheScores) {
  std::vector<double> stretched = kThreeGroups;
  for (double& score : stretched) score *= 300;
  EXPECT_THAT(select_by_otsu(stretched, OtsuRule::Bins100), ElementsAre(1, 2, 3, 4));
}

TEST(OtsuBins100, ScoreOnTheLowerEdgeIsInTheBin) {
  // Bins 0, 40, 99; cut after bin 40: 2 * 1 * (20 - 99)^2 = 12482 against 1 * 2 * (0 - 69.5)^2 = 9660.5.
  // 2/9 lies on the lower edge of bin 40 of 0 .. 5/9, so it is accepted with its bin.
  EXPECT_THAT(select_by_otsu({5.0 / 9, 0, 2.0 / 9}, OtsuRule::Bins100), ElementsAre(0, 2));
  EXPECT_THAT(select_by_otsu({5, 0, 2}, OtsuRule::Bins100), ElementsAre(0, 2));
}

TEST(OtsuCovis, CutsAtTheBinNumberOverBinsLessOne) {
  // 9 scores, 3 bins with 3, 2 and 4 of them. Cut after bin 0: 3 * 6 * (0 - 10/6)^2 = 50; after bin 1:
  // 5 * 4 * (0.4 - 2)^2 = 51.2. Threshold 1 / (3 - 1) = 0.5, strict: 0.6 passes although its bin is in the lower class.
  EXPECT_THAT(select_by_otsu({0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}, OtsuRule::Covis),
              ElementsAre(4, 5, 6, 7, 8));
}

TEST(OtsuCovis, ScoresOutsideZeroToOneFallInTheEndBins) {
  EXPECT_THAT(select_by_otsu({-3, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 12}, OtsuRule::Covis), ElementsAre(4, 5, 6, 7, 8));
}

TEST(OtsuCovis, OneBinKeepsAll) {
  EXPECT_THAT(select_by_otsu({0.35, 0.5, 0.6, 0.4, 0.45, 0.5, 0.5, 0.65, 0.34}, OtsuRule::Covis),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
}

}  // namespace
}  // namespace corral
