// SPDX-License-Identifier: MIT
#include "kernel/weighted_fit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kernel/evaluation.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

Indices all_rows(const CorrespondenceSet& table) {
  Indices rows(static_cast<std::size_t>(table.size()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(WeightedFit, EqualWeightsGiveTheFitWithoutWeights) {
  const CorrespondenceSet table = testing::synthetic(30, 0.7, 1).matches;
  const auto weighted = fit_weighted(table, all_rows(table), std::vector<double>(30, 0.25));
  const auto plain = fit_rigid_transform(table, all_rows(table));
  ASSERT_TRUE(weighted && plain);
  EXPECT_LT(rotation_error_deg(*weighted, *plain), 1e-9);
  EXPECT_TRUE(weighted->translation.isApprox(plain->translation, 1e-9));
}

TEST(WeightedFit, AWeightOfTwoIsTheRowTwice) {
  const CorrespondenceSet table = testing::synthetic(6, 0.5, 2).matches;
  const auto weighted = fit_weighted(table, {0, 1, 2, 3, 4, 5}, {1, 2, 1, 1, 0, 1});
  const auto twice = fit_rigid_transform(table, {0, 1, 1, 2, 3, 5});
  ASSERT_TRUE(weighted && twice);
  EXPECT_LT(rotation_error_deg(*weighted, *twice), 1e-9);
  EXPECT_TRUE(weighted->translation.isApprox(twice->translation, 1e-9));
}

TEST(WeightedFit, NoModelForTooFewRowsOrALine) {
  const std::vector<testing::Row3> corner = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                                   line = {{0, 0, 0}, {9, 0, 0}, {5, 0, 0}, {1, 0, 0}};
  const Indices rows = {0, 1, 2, 3};
  EXPECT_TRUE(fit_weighted(testing::table_of_points(corner, corner), rows, {1, 1, 1, 0}));
  EXPECT_FALSE(fit_weighted(testing::table_of_points(corner, corner), rows, {1, 1, 0, 0}));
  EXPECT_FALSE(fit_weighted(testing::table_of_points(line, corner), rows, {1, 1, 1, 1}));
  EXPECT_FALSE(fit_weighted(testing::table_of_points(corner, line), rows, {1, 1, 1, 1}));
}

TEST(WeightedFit, HowThinIsInPr) {
  for (const double resolution : {1.0, 0.125}) {
    const auto fit = [&](double height) {
      const double h = height * resolution;
      CorrespondenceSet table = testing::table_of_points({{-resolution, 0, 0}, {resolution, 0, 0}, {0, h, 0}},
                                                         {{-resolution, 0, 0}, {resolution, 0, 0}, {0, h, 0}});
      table.resolution = resolution;
      return fit_weighted(table, {0, 1, 2}, {1, 1, 1}).has_value();
    };
    const double limit = 1e-3 / std::sqrt(2.0 / 9);  // sum of squares of (-h/3, -h/3, 2h/3) is 2/3 h^2
    EXPECT_FALSE(fit(0.99 * limit));
    EXPECT_TRUE(fit(1.01 * limit));
  }
}

TEST(WeightedFit, MirroredPointsGetAProperRotation) {
  CorrespondenceSet table = testing::full_table(8);
  table.target_points = table.source_points;
  table.target_points.col(1) *= -1;
  const auto fit = fit_weighted(table, all_rows(table), std::vector<double>(8, 1.0));
  ASSERT_TRUE(fit);
  EXPECT_TRUE(is_rotation(fit->rotation, 1e-9));
}

}  // namespace
}  // namespace corral
