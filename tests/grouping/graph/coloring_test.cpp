// SPDX-License-Identifier: MIT
#include "grouping/graph/coloring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

/// The colour of each node from its definition, 0 of those that get none.
Indices colors_by_definition(const BitGraph& graph, const Indices& nodes) {
  Indices colors(static_cast<std::size_t>(graph.size()));
  for (const int node : nodes) {
    const auto is_taken = [&](int color) {
      return std::any_of(nodes.begin(), nodes.end(), [&](int other) {
        return colors[static_cast<std::size_t>(other)] == color && graph.is_edge(node, other);
      });
    };
    int color = 1;
    while (is_taken(color)) ++color;
    colors[static_cast<std::size_t>(node)] = color;
  }
  return colors;
}

void expect_colors_by_definition(const BitGraph& graph, bool are_listed, RandomStream& random) {
  const MissingEdges missing(graph);
  ASSERT_EQ(missing.are_listed(), are_listed);
  Coloring coloring(graph, missing);
  std::vector<BitGraph::Word> bits(static_cast<std::size_t>(graph.words()));
  Indices nodes, order, colors;
  for (int node = 0; node < graph.size(); ++node)
    if (random.uniform() < 0.8) {
      nodes.push_back(node);
      bits[static_cast<std::size_t>(node / 64)] |= BitGraph::Word{1} << node % 64;
    }
  const Indices expected = colors_by_definition(graph, nodes);
  const int most = *std::max_element(expected.begin(), expected.end());
  for (const int least : {1, most / 2, most}) {
    Indices by_color;
    for (const int node : nodes)
      if (expected[static_cast<std::size_t>(node)] >= least) by_color.push_back(node);
    std::stable_sort(by_color.begin(), by_color.end(), [&](int a, int b) {
      return expected[static_cast<std::size_t>(a)] < expected[static_cast<std::size_t>(b)];
    });
    ASSERT_EQ(coloring(bits, least, order, colors), most);
    ASSERT_EQ(order, by_color);
    for (std::size_t k = 0; k < order.size(); ++k) ASSERT_EQ(colors[k], expected[static_cast<std::size_t>(order[k])]);
  }
  EXPECT_GE(coloring.work(), 3 * graph.words());
}

TEST(Coloring, IsThatOfTheDefinition) {
  RandomStream random(1);
  for (const double density : {0.1, 0.5, 0.9, 0.97})
    for (int graph = 0; graph < 20; ++graph)
      expect_colors_by_definition(testing::random_graph(random, 150, density), false, random);
}

/// By the few edges that there are not.
TEST(Coloring, OfGraphsThatLackFewEdges) {
  RandomStream random(2);
  for (int number = 0; number < 40; ++number) {
    BitGraph graph = testing::random_graph(random, 800, 0.9995);
    for (int a = 1; a < 7; ++a)  // some nodes lack more, to each other
      for (int b = 0; b < a; ++b)
        if (random.uniform() < 0.6) graph.disconnect(300 + a, 300 + b);
    expect_colors_by_definition(graph, true, random);
  }
  expect_colors_by_definition(testing::random_graph(random, 200, 1), true, random);
}

}  // namespace
}  // namespace corral
