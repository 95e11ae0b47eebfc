// SPDX-License-Identifier: MIT
#include "grouping/graph/compatibility_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "grouping/columns/compatibility.h"
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

// Half of the columns stored, and none: everything that ST asks of a graph, to the last bit.
TEST(CompatibilityGraph, WhatIsStoredDoesNotMatter) {
  for (const std::int64_t each : testing::available_targets())
    for (const int rows : {1, 40, 333, 1000}) {
      const testing::ForcedTarget forced(each);
      const CorrespondenceSet matches = testing::harsh_table(rows, 0.3, 2);
      const CompatibilityGraph stored(matches, kSimilarity);
      Indices nodes;
      for (int node = 0; node < rows; node += node % 3 + 1) nodes.push_back(node);
      for (const double most_stored : {0.0, rows * (rows / 16.0)}) {
        const CompatibilityGraph computed(matches, kSimilarity, most_stored);
        EXPECT_EQ(computed.degrees(), stored.degrees());
        const std::pair<const GraphMatrix*, const GraphMatrix*> whole{&computed, &stored};
        const auto some = computed.restricted(nodes), expected_some = stored.restricted(nodes);
        CompatibilityGraph kept(matches, kSimilarity, most_stored);
        kept.keep(nodes);
        for (const auto& [graph, expected] : {whole, {some.get(), expected_some.get()}, {&kept, expected_some.get()}}) {
          const Eigen::VectorXd numbers = random_numbers(graph->size(), 1);
          Eigen::VectorXd product, expected_product, rounded = numbers, expected_rounded = numbers;
          graph->multiply(numbers, product);
          expected->multiply(numbers, expected_product);
          EXPECT_EQ(product, expected_product) << rows << " " << most_stored;
          graph->round_and_multiply(rounded, product);
          expected->round_and_multiply(expected_rounded, expected_product);
          EXPECT_EQ(rounded, expected_rounded) << rows << " " << most_stored;
          EXPECT_EQ(product, expected_product) << rows << " " << most_stored;
          for (int node = graph->size() - 1; node >= 0; node -= 1 + node % 5) {
            graph->get_column(node, product);
            expected->get_column(node, expected_product);
            ASSERT_EQ(product, expected_product) << rows << " " << most_stored << " " << node;
          }
        }
      }
    }
}

// In place, again and again, as ST does: the front, the end, all, every other one.
TEST(CompatibilityGraph, KeepsSomeNodesAgainAndAgain) {
  const CorrespondenceSet matches = testing::harsh_table(333, 0.3, 2);
  for (const double most_stored : {0.0, 333 * 20.0, CompatibilityGraph::kMostStored}) {
    CompatibilityGraph graph(matches, kSimilarity, most_stored);
    Eigen::MatrixXd expected = dense(matches);
    for (const auto& [first, last, step] :
         {std::array{0, 333, 1}, {5, 333, 1}, {0, 320, 1}, {0, 320, 3}, {1, 100, 2}, {0, 1, 1}, {0, 0, 1}}) {
      Indices nodes;
      for (int node = first; node < last; node += step) nodes.push_back(node);
      graph.keep(nodes);
      expected = Eigen::MatrixXd(expected(nodes, nodes));
      ASSERT_EQ(graph.size(), expected.cols());
      Eigen::VectorXd column;
      for (int node = 0; node < graph.size(); ++node) {
        graph.get_column(node, column);
        ASSERT_EQ(column, expected.col(node)) << most_stored << " " << last << " " << node;
      }
      EXPECT_EQ(graph.degrees(), expected.rowwise().sum());
    }
  }
}

TEST(CompatibilityGraph, ProductWithAFewNumbers) {
  const CorrespondenceSet matches = testing::harsh_table(333, 0.3, 2);
  for (const double most_stored : {0.0, 333 * 20.0, CompatibilityGraph::kMostStored}) {
    const CompatibilityGraph graph(matches, kSimilarity, most_stored);
    for (const Indices& nodes : {Indices{0}, {332}, {3, 4, 200}, {8, 16, 24, 32, 40, 331}}) {
      Eigen::VectorXd few = Eigen::VectorXd::Zero(333), product;
      for (const int node : nodes) few(node) = node + 1;
      graph.round_and_multiply(few, product);
      EXPECT_EQ(product, dense(matches) * few) << most_stored << " " << nodes.size();
    }
  }
}

TEST(CompatibilityGraph, StoresNoMoreThanItMay) {
  EXPECT_LT(CompatibilityGraph::memory(1000000), CompatibilityGraph::kMostStored + 100e6);
  EXPECT_GT(CompatibilityGraph::memory(1000000), CompatibilityGraph::kMostStored);
  EXPECT_LT(CompatibilityGraph::memory(1000, 0), 50e3);
}

}  // namespace
}  // namespace corral
