// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_weights.h"

#include <gtest/gtest.h>

#include "tests/support/execution.h"
#include "tests/support/random_graphs.h"

namespace corral {
namespace {

/// Replaces the weights by the sums of paths.
void add_up_paths(EdgeWeights& weights) {
  PathSums paths(weights);
  paths.visit([](double) { return 1.0; }, [&](const PathSums::PathSum&) {});  // leaves nothing for the next
  paths.visit([](double weight) { return weight; },
              [&](const PathSums::PathSum& path) {
                EXPECT_LT(path.node, path.other);
                weights.set(path.there, path.sum), weights.set(path.back, path.sum);
              });
}

TEST(EdgeWeights, SumsOfPathsAreThoseOfAMatrixProduct) {
  RandomStream random(2);
  for (const int nodes : {0, 1, 5, 64, 90}) {
    const BitGraph graph = testing::random_graph(random, nodes, random.uniform());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(nodes, nodes);
    EdgeWeights weights(graph);
    weights.replace_each([&](int a, int b, double old) {
      EXPECT_TRUE(graph.is_edge(a, b));
      EXPECT_LT(a, b);
      return matrix(a, b) = matrix(b, a) = old + (a + 1) * (b + 1) / 100.0;
    });
    EXPECT_EQ((matrix.array() > 0).count(), [&] {
      int count = 0;
      for (int node = 0; node < nodes; ++node) count += graph.degree(node);
      return count;
    }());
    add_up_paths(weights);
    const Eigen::MatrixXd expected = matrix.cwiseProduct(matrix * matrix);
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(nodes, nodes);
    for (int node = 0; node < nodes; ++node)
      weights.for_edges(node, [&](int other, double sum) { found(node, other) = sum; });
    EXPECT_EQ(found, found.transpose());
    EXPECT_LE((found - expected).cwiseAbs().sum(), 1e-12 * expected.sum());
    std::vector<double> factors;
    for (int node = 0; node < nodes; ++node) factors.push_back(node % 3);
    for (int node = 0; node < nodes; ++node)
      EXPECT_NEAR(weights.sum_of_products(node, factors),
                  expected.row(node).dot(Eigen::Map<const Eigen::VectorXd>(factors.data(), nodes)),
                  1e-12 * expected.sum());
  }
}

/// One edge more or less in eight pairs decides which loop adds the products: the sums of what both hold are the same.
TEST(EdgeWeights, SumsOfPathsDoNotDependOnTheLoop) {
  RandomStream random(3);
  int compared = 0;
  for (const int nodes : {24, 61, 130}) {
    BitGraph dense = testing::random_graph(random, nodes, 0.12), sparse = dense;
    const auto share = [&] {
      int edges = 0;
      for (int node = 0; node < nodes; ++node) edges += dense.degree(node);
      return 8.0 * edges / (1.0 * nodes * nodes);
    };
    // Edges between two nodes that are joined to no other: they add to no other sum.
    BitGraph padded_graph(nodes + 40);
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < a; ++b)
        if (dense.is_edge(a, b)) padded_graph.connect(a, b);
    EXPECT_LT(share(), 1.3);
    sparse = padded_graph;
    for (int a = nodes; a < nodes + 40; ++a)
      for (int b = nodes; b < a; ++b) padded_graph.connect(a, b);
    const auto sums = [&](const BitGraph& graph) {
      EdgeWeights weights(graph);
      weights.replace_each([](int a, int b, double) { return 1.0 / (1 + a) + 1.0 / (3 + b); });
      add_up_paths(weights);
      std::vector<double> all;
      for (int node = 0; node < nodes; ++node)
        weights.for_edges(node, [&](int other, double sum) {
          if (other < nodes) all.push_back(sum);
        });
      return all;
    };
    for (const std::int64_t each : testing::available_targets()) {
      const testing::ForcedTarget forced(each);
      EXPECT_EQ(sums(padded_graph), sums(sparse)) << nodes;
    }
    compared += static_cast<int>(sums(sparse).size());
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace corral
