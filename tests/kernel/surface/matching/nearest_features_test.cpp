// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/nearest_features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include "kernel/random.h"
#include "kernel/surface/matching/feature_filter.h"
#include "tests/support/execution.h"
#include "tests/support/reference/matching.h"

namespace corral {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

void expect_equal(const NearestFeatures& found, const NearestFeatures& expected) {
  EXPECT_EQ(found.nearest, expected.nearest);
  ASSERT_EQ(found.squared_distance.size(), expected.squared_distance.size());
  ASSERT_EQ(found.second_squared_distance.size(), expected.second_squared_distance.size());
  EXPECT_EQ(found.squared_distance, expected.squared_distance);  // bit by bit: none is NaN or -0
  EXPECT_EQ(found.second_squared_distance, expected.second_squared_distance);
}

void backwards(int count, const std::function<void(int)>& body) {
  for (int i = count - 1; i >= 0; --i) body(i);
}

void in_threads(int count, const std::function<void(int)>& body) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      for (int i = t; i < count; i += 3) body(i);
    });
  for (std::thread& thread : threads) thread.join();
}

/// On every target, and in blocks of any order.
void expect_exact(const MatrixXd& source, const MatrixXd& target) {
  const NearestFeatures expected = testing::reference_nearest_features(source, target);
  for (const std::int64_t each : testing::available_targets()) {
    const testing::ForcedTarget forced(each);
    expect_equal(find_two_nearest(source, target), expected);
  }
  expect_equal(find_two_nearest(source, target, backwards), expected);
  expect_equal(find_two_nearest(source, target, in_threads), expected);
}

/// Filled number by number.
MatrixXd filled(Index rows, Index columns, const std::function<double()>& number) {
  MatrixXd result(rows, columns);
  for (double& each : result.reshaped()) each = number();
  return result;
}

MatrixXd uniform(Index rows, Index columns, std::uint64_t seed) {
  RandomStream random(seed);
  return filled(rows, columns, [&] { return random.uniform(-1, 1); });
}

/// Unit columns that are not negative and mostly zero, in clusters, as histograms of surfaces are.
MatrixXd histograms(Index rows, Index columns, std::uint64_t seed) {
  RandomStream random(seed), common(99);
  const MatrixXd kinds = filled(rows, 12, [&] { return common.uniform() < 0.2 ? common.uniform() : 0; });
  MatrixXd result(rows, columns);
  for (auto column : result.colwise()) {
    const Index a = static_cast<Index>(random.below(12)), b = static_cast<Index>(random.below(12));
    const double share = random.uniform();
    column = share * kinds.col(a) + (1 - share) * kinds.col(b);
    for (double& number : column)
      if (random.uniform() < 0.2) number += 0.3 * random.uniform();
    column.normalize();
  }
  return result;
}

TEST(NearestFeatures, UniformNumbers) {
  expect_exact(uniform(352, 210, 1), uniform(352, 330, 2));
  expect_exact(uniform(352, 700, 3), uniform(352, 64, 4));
  expect_exact(uniform(352, 49, 5), uniform(352, 1001, 6));
}

TEST(NearestFeatures, Histograms) {
  expect_exact(histograms(352, 500, 1), histograms(352, 770, 2));
  const MatrixXd both = histograms(352, 300, 3);
  expect_exact(both, both);
}

TEST(NearestFeatures, AnyDimension) {
  // Up to 62 dimensions the bounds are the distances: nothing but rounding is between them.
  for (const Index rows : {1, 3, 8, 17, 31, 33, 62, 65, 1000})
    expect_exact(uniform(rows, 430, 7), uniform(rows, 440, 8));
}

TEST(NearestFeatures, Clusters) {
  // Far from the origin, narrow, and copies of each other.
  RandomStream random(9);
  const MatrixXd centers = 1000 * uniform(352, 5, 10);
  const auto clustered = [&](Index columns, double width) {
    MatrixXd result = filled(352, columns, [&] { return random.uniform(-width, width); });
    for (auto column : result.colwise()) column += centers.col(static_cast<Index>(random.below(5)));
    return result;
  };
  for (const double width : {1.0, 1e-3, 1e-6, 1e-10}) expect_exact(clustered(150, width), clustered(250, width));
}

TEST(NearestFeatures, MassesOfTies) {
  RandomStream random(11);
  for (const Index rows : {2, 5, 20, 352}) {
    const auto number = [&] { return static_cast<double>(random.below(rows > 100 ? 2 : 3)); };
    expect_exact(filled(rows, 450, number), filled(rows, 460, number));
  }
  MatrixXd few = uniform(352, 9, 12), many(352, 333);
  for (auto column : many.colwise()) column = few.col(static_cast<Index>(random.below(9)));
  expect_exact(uniform(352, 130, 13), many);
  expect_exact(few.replicate(1, 30), many);
}

TEST(NearestFeatures, AllIdentical) {
  const MatrixXd one = histograms(352, 1, 14);
  expect_exact(one.replicate(1, 200), one.replicate(1, 210));
  expect_exact(histograms(352, 200, 15), one.replicate(1, 210));
  const NearestFeatures found = find_two_nearest(histograms(352, 200, 15), one.replicate(1, 210));
  EXPECT_THAT(found.nearest, Each(0));
  EXPECT_EQ(found.squared_distance, found.second_squared_distance);
  expect_exact(MatrixXd::Zero(352, 200), MatrixXd::Zero(352, 210));
}

TEST(NearestFeatures, NearTies) {
  // Distances that differ by 1e-12 of themselves and less, in all orders.
  RandomStream random(16);
  for (const Index rows : {12, 352})
    for (const double step : {1e-7, 1e-9, 1e-12, 1e-15}) {
      const MatrixXd source = uniform(rows, 400, 17);
      MatrixXd target = uniform(rows, 400, 18);
      for (Index column = 1; column < 400; ++column)
        if (column % 8 != 0) target.col(column) = target.col(column - 1);
      for (auto column : target.colwise())
        column(static_cast<Index>(random.below(rows))) *= 1 + random.uniform() * step;
      expect_exact(source, target);
      expect_exact(target, target);
    }
}

TEST(NearestFeatures, TargetsOnASphere) {
  // All as far as any other but for a last few digits, so that only the rounding of floats decides what is seen first.
  for (const Index rows : {3, 12, 30, 60, 352})
    for (const double width : {1e-14, 1e-10, 1e-8}) {
      MatrixXd target = uniform(rows, 600, 44);
      target.colwise().normalize();
      const Eigen::VectorXd center = 3 * uniform(rows, 1, 46);
      const MatrixXd source = (width * uniform(rows, 300, 45)).colwise() + center;
      expect_exact(source, target.colwise() + center);
    }
}

TEST(NearestFeatures, HugeAndTinyNumbers) {
  for (const double size : {1e-300, 1e-160, 1e-150, 1e-100, 1e-40, 1e-20, 1e20, 1e40, 1e100, 1e150, 1e160, 1e300}) {
    SCOPED_TRACE(size);
    expect_exact(size * uniform(352, 170, 19), size * uniform(352, 180, 20));
  }
}

TEST(NearestFeatures, WidelyDifferentLengths) {
  RandomStream random(21);
  for (const double decades : {3.0, 12.0, 100.0, 300.0}) {
    MatrixXd source = uniform(352, 170, 22), target = uniform(352, 330, 23);
    for (MatrixXd* each : {&source, &target})
      for (auto column : each->colwise()) column *= std::pow(10, random.uniform(-decades, decades) / 2);
    SCOPED_TRACE(decades);
    expect_exact(source, target);
  }
  // One that the sample did not see, where floats end; once among the sources, once among the targets.
  MatrixXd far = uniform(352, 700, 24);
  far.col(101) *= 1e120;
  far.col(503) *= 1e30;
  expect_exact(far, uniform(352, 300, 25));
  expect_exact(uniform(352, 300, 25), far);
}

TEST(NearestFeatures, FewFeatures) {
  for (const Index targets : {1, 2, 3, 63, 64, 65})
    for (const Index sources : {1, 2, 50})
      for (const Index rows : {1, 352}) expect_exact(uniform(rows, sources, 26), uniform(rows, targets, 27));
  for (const Index targets : {64, 65, 127, 128}) expect_exact(uniform(352, 400, 28), uniform(352, targets, 29));
}

TEST(NearestFeatures, SingleTargetHasNoSecond) {
  const NearestFeatures found = find_two_nearest(uniform(20, 4, 30), uniform(20, 1, 31));
  EXPECT_THAT(found.nearest, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(found.second_squared_distance, Eigen::VectorXd(Eigen::VectorXd::Zero(4)));
  EXPECT_GT(found.squared_distance.minCoeff(), 0);
}

TEST(NearestFeatures, EmptySideGivesNothing) {
  for (const auto& [sources, targets] : {std::pair(0, 300), std::pair(300, 0), std::pair(0, 0)}) {
    const NearestFeatures found = find_two_nearest(MatrixXd::Zero(20, sources), MatrixXd::Zero(20, targets));
    EXPECT_THAT(found.nearest, IsEmpty());
    EXPECT_EQ(found.squared_distance.size(), 0);
    EXPECT_EQ(found.second_squared_distance.size(), 0);
  }
}

TEST(NearestFeatures, DistancesAreTheUsualOnes) {
  const MatrixXd source = histograms(352, 200, 32), target = histograms(352, 300, 33);
  const NearestFeatures found = find_two_nearest(source, target);
  for (Index i = 0; i < source.cols(); ++i) {
    const double usual = (target.colwise() - source.col(i)).colwise().squaredNorm().minCoeff();
    EXPECT_NEAR(found.squared_distance(i), usual, 1e-14 * usual);
  }
}

/// Distances of the rows of two sides beyond those of the features and the errors that are allowed for.
double largest_excess(const MatrixXd& source, const MatrixXd& target) {
  const FeatureProjection projection(source, target);
  EXPECT_TRUE(projection.usable());
  const int sources = static_cast<int>(source.cols()), targets = static_cast<int>(target.cols());
  ProjectedFeatures a(source.rows(), sources), b(target.rows(), targets);
  projection.project(source, 0, sources, a);
  projection.project(target, 0, targets, b);
  using Rows = Eigen::Map<const Eigen::MatrixXf>;
  double largest = -std::numeric_limits<double>::infinity();
  const auto compare = [&](const FloatColumn& of_a, const FloatColumn& of_b, int numbers) {
    const MatrixXd rows_a = Rows(of_a.data(), numbers, sources).cast<double>(),
                   rows_b = Rows(of_b.data(), numbers, targets).cast<double>();
    for (int i = 0; i < sources; ++i)
      for (int j = 0; j < targets; ++j)
        largest = std::max(largest, (rows_a.col(i) - rows_b.col(j)).norm() - a.error[i] - b.error[j] -
                                        projection.scale() * (source.col(i) - target.col(j)).norm());
  };
  compare(a.coarse, b.coarse, kCoarseNumbers);
  compare(a.fine, b.fine, kFineNumbers);
  return largest;
}

TEST(FeatureProjection, DistancesAreLowerBounds) {
  EXPECT_LE(largest_excess(histograms(352, 90, 34), histograms(352, 110, 35)), 0);
  EXPECT_LE(largest_excess(uniform(352, 90, 36), uniform(352, 110, 37)), 0);
  for (const Index rows : {1, 5, 17, 40, 62})
    EXPECT_LE(largest_excess(uniform(rows, 90, 38), uniform(rows, 80, 39)), 0);
  const MatrixXd one = histograms(352, 1, 40);
  EXPECT_LE(largest_excess(one.replicate(1, 20), one.replicate(1, 30)), 0);
}

TEST(FeatureProjection, BoundsAreTightWhereFeaturesAreAlike) {
  const MatrixXd source = histograms(352, 90, 41), target = histograms(352, 110, 42);
  const FeatureProjection projection(source, target);
  ProjectedFeatures rows(352, 90);
  projection.project(source, 0, 90, rows);
  for (int i = 0; i < 90; ++i) EXPECT_LT(rows.error[i], 0.01 * std::sqrt(rows.fine_squared[i]));
  double kept = 0;
  for (int i = 0; i < 90; ++i)
    for (int k = 0; k < kCoarseNumbers - 2; ++k) kept += std::pow(rows.coarse[i * kCoarseNumbers + k], 2);
  EXPECT_GT(kept, 0.5 * Eigen::Map<Eigen::VectorXd>(rows.coarse_squared.data(), 90).sum());
}

TEST(FeatureFilter, IsUsableWhereFloatsAre) {
  const MatrixXd features = histograms(352, 200, 43);
  for (const double size : {1e-100, 1e-20, 1.0, 1e20, 1e100})
    EXPECT_TRUE(FeatureFilter(size * features, size * features, one_by_one).usable()) << size;
  for (const double size : {1e-150, 1e150})
    EXPECT_FALSE(FeatureFilter(size * features, size * features, one_by_one).usable()) << size;
}

}  // namespace
}  // namespace corral
