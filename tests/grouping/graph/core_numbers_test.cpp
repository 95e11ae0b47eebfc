// SPDX-License-Identifier: MIT
#include "grouping/graph/core_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include <numeric>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(CoreNumbers, OfATriangleWithATailAndALoneNode) {
  const CoreNumbers cores = core_numbers(testing::graph_of(6, {{0, 1}, {1, 2}, {0, 2}, {2, 3}, {3, 4}}));
  EXPECT_THAT(cores.numbers, ElementsAre(2, 2, 2, 1, 1, 0));
  EXPECT_EQ(cores.order.front(), 5);
}

TEST(CoreNumbers, OfNothing) { EXPECT_THAT(core_numbers(BitGraph(0)).numbers, IsEmpty()); }

/// The largest k whose core holds the node, by removing every node of fewer than k neighbours until none is left.
Indices numbers_by_definition(const BitGraph& graph) {
  Indices numbers(static_cast<std::size_t>(graph.size()), 0);
  for (int k = 1; k < graph.size(); ++k) {
    Indices left(numbers.size());
    std::iota(left.begin(), left.end(), 0);
    for (std::size_t before = left.size() + 1; before != left.size();) {
      before = left.size();
      const Indices all = left;
      left.clear();
      for (const int node : all)
        if (std::count_if(all.begin(), all.end(), [&](int other) { return graph.is_edge(node, other); }) >= k)
          left.push_back(node);
    }
    for (const int node : left) numbers[static_cast<std::size_t>(node)] = k;
  }
  return numbers;
}

TEST(CoreNumbers, AreThoseOfTheDefinition) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomStream random(seed);
    const int most = seed % 20 == 0 ? 150 : 30;  // some of several words
    const BitGraph graph = testing::random_graph(random, 1 + static_cast<int>(random.below(most)), random.uniform());
    const CoreNumbers cores = core_numbers(graph);
    ASSERT_EQ(cores.numbers, numbers_by_definition(graph)) << "seed " << seed;
    int last = 0;
    for (auto node = cores.order.begin(); node != cores.order.end(); ++node) {
      const int number = cores.numbers[static_cast<std::size_t>(*node)];
      EXPECT_GE(number, last);
      last = number;
      EXPECT_LE(std::count_if(node, cores.order.end(), [&](int other) { return graph.is_edge(*node, other); }), number);
    }
    Indices all = cores.order;
    std::sort(all.begin(), all.end());
    for (int node = 0; node < graph.size(); ++node) ASSERT_EQ(all[static_cast<std::size_t>(node)], node);
  }
}

}  // namespace
}  // namespace corral
