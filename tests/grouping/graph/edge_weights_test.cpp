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
    for (int node = 0; node < nodes; ++node)
      weights.for_edges(node, [&](int other, double sum) {
        EXPECT_NEAR(sum, expected(node, other), 1e-12 * expected(node, other));
        EXPECT_EQ(sum, weights.weight(other, node));
      });
  }
}

}  // namespace
}  // namespace corral
