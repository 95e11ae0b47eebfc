// SPDX-License-Identifier: MIT
#include "grouping/graph/common_neighbors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/execution.h"
#include "tests/support/random_graphs.h"

namespace corral {
namespace {

/// As many nodes as asked for at random in a part that lacks few edges; the others have few.
BitGraph dense_part(int nodes, int dense, std::uint64_t seed) {
  RandomStream random(seed);
  BitGraph graph(nodes);
  for (int a = 0; a < nodes; ++a)
    for (int b = 0; b < a; ++b)
      if (random.uniform() < ((a * 7) % nodes < dense && (b * 7) % nodes < dense ? 0.97 : 0.05)) graph.connect(a, b);
  return graph;
}

void expect_counts_of_the_plain_form(const BitGraph& graph) {
  CommonNeighbors common(graph);
  Indices all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  Indices expected(all.size());
  std::vector<BitGraph::Word> found;
  for (int node = 0; node < graph.size(); ++node) {
    ASSERT_EQ(common.degree(node), graph.degree(node));
    graph.count_common(node, all, expected.data());
    for (const int first : {0, graph.words() / 2}) {
      const std::vector<int> counts = common.count(node, first, graph.words());
      const int fewest = 1 + expected[static_cast<std::size_t>(node)] / 2;
      common.find(fewest, found);
      for (int j = 64 * first; j < 64 * graph.words(); ++j) {
        const int count = j < graph.size() ? expected[static_cast<std::size_t>(j)] : 0;
        ASSERT_EQ(counts[static_cast<std::size_t>(j - 64 * first)], count) << node << " " << j;
        ASSERT_EQ(found[static_cast<std::size_t>(j / 64 - first)] >> j % 64 & 1, count >= fewest) << node << " " << j;
      }
    }
  }
}

TEST(CommonNeighbors, AreThoseOfThePlainForm) {
  for (const std::int64_t target : testing::available_targets()) {
    const testing::ForcedTarget forced(target);
    SCOPED_TRACE(testing::target_name(target));
    for (const int nodes : {0, 1, 2, 63, 64, 65, 200, 333})
      for (const int dense : {0, nodes / 2, nodes}) expect_counts_of_the_plain_form(dense_part(nodes, dense, 1));
  }
}

TEST(CommonNeighbors, OfMoreRowsAndWordsThanAreAddedUpTogether) {
  constexpr int kNodes = 9000;  // 141 words; more neighbours than twelve digits count
  BitGraph graph(kNodes);
  for (int a = 0; a < kNodes; ++a)
    for (int b = a % 2; b < a; b += 2) graph.connect(a, b);  // two cliques, of 4500 nodes each
  CommonNeighbors common(graph);
  const std::vector<int>& counts = common.count(1, 0, graph.words());
  for (int j = 0; j < kNodes; ++j)
    ASSERT_EQ(counts[static_cast<std::size_t>(j)], j == 1 ? 4499 : j % 2 == 1 ? 4498 : 0) << j;
}

}  // namespace
}  // namespace corral
