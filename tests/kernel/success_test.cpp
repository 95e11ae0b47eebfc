// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"

namespace corral {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using Errors = std::vector<std::optional<double>>;

TEST(SuccessThresholds, ThoseOfTheField) {
  EXPECT_THAT(success_thresholds_pr(), ElementsAre(0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5));
}

TEST(SuccessCurve, ShareOfPairsUpToEachThreshold) {
  const Errors errors{0.2, 1.0, 1.2, 4.9};
  EXPECT_THAT(success_curve(errors), ElementsAre(0.25, 0.5, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 1));
  EXPECT_THAT(success_curve(errors, {0, 1, 10}), ElementsAre(0, 0.5, 1));
}

TEST(SuccessCurve, ThresholdIsInclusive) {
  EXPECT_THAT(success_curve({5.0}, {5.0}), ElementsAre(1));
  EXPECT_THAT(success_curve({std::nextafter(5.0, 6.0)}, {5.0}), ElementsAre(0));
  EXPECT_THAT(success_curve({0.0}, {0.0}), ElementsAre(1));
}

TEST(SuccessCurve, WithoutAPoseAPairIsAFailureAndCounts) {
  EXPECT_THAT(success_curve({std::nullopt, 0.1, std::nullopt, 0.1}), Each(0.5));
  EXPECT_THAT(success_curve({std::nullopt}), Each(0));
}

TEST(SuccessCurve, NotANumberIsAFailure) {
  EXPECT_THAT(success_curve({std::numeric_limits<double>::quiet_NaN(), 0.1}), Each(0.5));
  EXPECT_THAT(success_curve({std::numeric_limits<double>::infinity()}), Each(0));
}

TEST(SuccessCurve, NoPairsAreRefused) {
  EXPECT_THROW(success_curve({}), InvalidInput);
  EXPECT_THROW(success_area({}), InvalidInput);
}

TEST(SuccessArea, OnePair) {
  EXPECT_DOUBLE_EQ(success_area({0.0}), 1);           // the whole curve
  EXPECT_DOUBLE_EQ(success_area({0.3}), 0.95);        // rises over the first of ten steps: half of it is lost
  EXPECT_DOUBLE_EQ(success_area({0.5}), 0.95);        // the same: thresholds are inclusive
  EXPECT_DOUBLE_EQ(success_area({2.1}), 0.55);        // four steps without, half of the fifth, five with
  EXPECT_DOUBLE_EQ(success_area({5.0}), 0.05);        // half of the last step
  EXPECT_DOUBLE_EQ(success_area({5.01}), 0);          // beyond the last threshold
  EXPECT_DOUBLE_EQ(success_area({std::nullopt}), 0);  // no pose
}

TEST(SuccessArea, MeanOfThePairs) {
  RandomStream random(7);
  Errors errors;
  double sum = 0;
  for (int pair = 0; pair < 50; ++pair) {
    errors.push_back(random.uniform() < 0.2 ? std::nullopt : std::optional<double>(8 * random.uniform()));
    sum += success_area({errors.back()});
  }
  EXPECT_NEAR(success_area(errors), sum / 50, 1e-12);
}

TEST(SuccessArea, EvenlySpreadErrorsGiveHalf) {
  Errors errors;
  for (int step = 0; step < 10; ++step) errors.push_back(0.25 + 0.5 * step);
  EXPECT_NEAR(success_area(errors), 0.5, 1e-12);
}

}  // namespace
}  // namespace corral
