// SPDX-License-Identifier: MIT
#include "grouping/graph/induced_subgraph.h"

#include <gtest/gtest.h>

#include "tests/support/random_graphs.h"
#include "tests/support/row_order.h"

namespace corral {
namespace {

TEST(InducedSubgraph, EdgesAreThoseBetweenTheChosenNodes) {
  RandomStream random(1);
  for (const int nodes : {1, 63, 64, 65, 200}) {
    const BitGraph graph = testing::random_graph(random, nodes, 0.4);
    InducedSubgraphs induced(graph);
    for (const int chosen : {0, 1, nodes / 2, nodes}) {
      Indices names = testing::shuffled_rows(nodes, random.below(1000));
      names.resize(static_cast<std::size_t>(chosen));
      const BitGraph subgraph = induced(names);
      ASSERT_EQ(subgraph.size(), chosen);
      for (int a = 0; a < chosen; ++a)
        for (int b = 0; b < chosen; ++b)
          ASSERT_EQ(subgraph.is_edge(a, b),
                    graph.is_edge(names[static_cast<std::size_t>(a)], names[static_cast<std::size_t>(b)]));
    }
  }
}

}  // namespace
}  // namespace corral
