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

/// As PathSums says that it adds.
double sum_of_eight(const Eigen::MatrixXd& values, int i, int j) {
  double s[8] = {};
  for (int k = 0; k < values.cols(); ++k) s[k % 8] += values(i, k) * values(j, k);
  return values(i, j) * (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])));
}

/// Nodes that are joined to many and to few take different loops, with the same sums.
TEST(EdgeWeights, SumsOfPathsAreThoseOfPlainLoops) {
  RandomStream random(3);
  for (const int nodes : {7, 24, 61, 130})
    for (const double joined_to_many : {0.0, 0.1, 0.5, 1.0}) {
      std::vector<bool> is_joined;
      for (int node = 0; node < nodes; ++node) is_joined.push_back(random.uniform() < joined_to_many);
      BitGraph graph(nodes);
      for (int a = 0; a < nodes; ++a)
        for (int b = 0; b < a; ++b)
          if (random.uniform() <
              (is_joined[static_cast<std::size_t>(a)] && is_joined[static_cast<std::size_t>(b)] ? 0.9 : 0.06))
            graph.connect(a, b);
      EdgeWeights weights(graph);
      Eigen::MatrixXd values = Eigen::MatrixXd::Zero(nodes, nodes);
      weights.replace_each([&](int a, int b, double) { return values(a, b) = values(b, a) = random.uniform(); });
      for (const std::int64_t each : testing::available_targets()) {
        const testing::ForcedTarget forced(each);
        EdgeWeights sums = weights;
        add_up_paths(sums);
        for (int node = 0; node < nodes; ++node)
          sums.for_edges(node, [&](int other, double sum) {
            EXPECT_EQ(sum, sum_of_eight(values, std::min(node, other), std::max(node, other))) << node << " " << other;
          });
      }
    }
}

}  // namespace
}  // namespace corral
