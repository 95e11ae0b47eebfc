// SPDX-License-Identifier: MIT
#include "grouping/compatibility_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grouping/compatibility.h"
#include "kernel/random.h"
#include "tests/support/execution.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

constexpr double kSimilarity = 0.6;

Eigen::MatrixXd dense(const CorrespondenceSet& matches) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = 0; j < i; ++j) {
      const PairDistances distances = pair_distances(matches, i, j);
      matrix(i, j) = matrix(j, i) = rigidity_ratio(distances.source, distances.target) >= kSimilarity;
    }
  return matrix;
}

Eigen::VectorXd random_numbers(int count, double scale) {
  RandomStream random(5);
  Eigen::VectorXd numbers(count);
  for (double& number : numbers) number = scale * random.uniform(-1, 1);
  return numbers;
}

TEST(CompatibilityGraph, RoundedProductIsThatOfTheRoundedNumbers) {
  for (const std::int64_t each : testing::available_targets())
    for (const int rows : {1, 7, 40, 333})
      for (const double scale : {1.0, 1e-250, 1e200}) {
        const testing::ForcedTarget forced(each);
        const CorrespondenceSet matches = testing::harsh_table(rows, 0.3, 2);
        const Eigen::VectorXd numbers = random_numbers(rows, scale);
        Eigen::VectorXd rounded = numbers, product;
        CompatibilityGraph(matches, kSimilarity).round_and_multiply(rounded, product);
        EXPECT_EQ(product, dense(matches) * rounded) << rows << " rows";  // no sum is rounded
        EXPECT_LE((rounded - numbers).cwiseAbs().maxCoeff(), rows * scale * 0x1p-30) << rows << " rows";
      }
}

TEST(CompatibilityGraph, ProductIsThatOfTheMatrix) {
  const CorrespondenceSet matches = testing::harsh_table(333, 0.3, 2);
  const CompatibilityGraph graph(matches, kSimilarity);
  Eigen::VectorXd numbers = random_numbers(333, 1), product;
  numbers(100) = 1e-9;  // small beside the others, and not lost
  graph.multiply(numbers, product);
  EXPECT_LT((product - dense(matches) * numbers).cwiseAbs().maxCoeff(), 1e-13);
  graph.multiply(Eigen::VectorXd::Zero(333), product);
  EXPECT_TRUE(product.isZero(0));
}

TEST(CompatibilityGraph, RestrictedToSomeNodes) {
  const CorrespondenceSet matches = testing::harsh_table(100, 0.3, 2);
  const CompatibilityGraph graph(matches, kSimilarity);
  const Indices nodes{0, 1, 7, 8, 13, 40, 41, 42, 43, 77, 99};
  const auto some = graph.restricted(nodes);
  const Eigen::MatrixXd expected = dense(matches)(nodes, nodes);
  Eigen::VectorXd column;
  for (int node = 0; node < some->size(); ++node) {
    some->get_column(node, column);
    EXPECT_EQ(column, expected.col(node)) << node;
  }
}

}  // namespace
}  // namespace corral
