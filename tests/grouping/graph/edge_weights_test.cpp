// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_weights.h"

#include <gtest/gtest.h>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

TEST(EdgeWeights, SumsOfPathsAreThoseOfAMatrixProduct) {
  RandomStream random(2);
  for (const int nodes : {0, 1, 5, 64, 90}) {
    const BitGraph graph = testing::random_graph(random, nodes, random.uniform());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(nodes, nodes);
    EdgeWeights weights(graph);
    weights.replace_each([&](int a, int b, double old) {
      EXPECT_TRUE(graph.is_edge(a, b));
      return matrix(a, b) = old + (a + 1) * (b + 1) / 100.0;
    });
    EXPECT_EQ((matrix.array() > 0).count(), [&] {
      int count = 0;
      for (int node = 0; node < nodes; ++node) count += graph.degree(node);
      return count;
    }());
    weights.set(weights.path_sums());
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

}  // namespace
}  // namespace corral
