// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

Indices all_nodes(const BitGraph& graph) {
  Indices nodes(static_cast<std::size_t>(graph.size()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

int support(const BitGraph& graph, int a, int b) {
  Indices common(1);
  graph.count_common(a, {b}, common.data());
  return common[0];
}

TEST(EdgeSupport, InOneBlockItIsThatOfTheWholeGraph) {
  RandomStream random(3);
  const BitGraph whole = testing::random_graph(random, 300, 0.2);
  BitGraph graph = whole;
  const Indices nodes{2, 63, 64, 130, 200, 299};
  EdgeSupport(graph).remove_below(12, nodes);
  int removed = 0, kept = 0;
  for (int a = 0; a < whole.size(); ++a)
    for (int b = a + 1; b < whole.size(); ++b) {
      const bool is_named = std::binary_search(nodes.begin(), nodes.end(), b);
      const bool is_kept = whole.is_edge(a, b) && (!is_named || support(whole, a, b) >= 12);
      ASSERT_EQ(graph.is_edge(a, b), is_kept) << a << " " << b;
      ASSERT_EQ(graph.is_edge(b, a), is_kept) << a << " " << b;
      if (is_named && whole.is_edge(a, b)) ++(is_kept ? kept : removed);
    }
  EXPECT_GT(removed, 30);
  EXPECT_GT(kept, 30);
}

TEST(EdgeSupport, CliquesOfTheSizeLoseNoEdgeAndOthersDo) {
  constexpr int kClique = 60, kStep = 31;
  RandomStream random(5);
  BitGraph graph = testing::random_graph(random, kClique * kStep, 0.1);
  for (int a = 0; a < kClique; ++a)
    for (int b = 0; b < a; ++b) graph.connect(kStep * a, kStep * b);
  EdgeSupport(graph).remove_below(kClique - 2, all_nodes(graph));
  int left = 0;
  for (int a = 0; a < graph.size(); ++a) left += graph.degree(a);
  for (int a = 0; a < kClique; ++a)
    for (int b = 0; b < a; ++b) EXPECT_TRUE(graph.is_edge(kStep * a, kStep * b));
  EXPECT_LT(left, 2 * kClique * kClique);
}

/// With a clique of four new nodes: so it has more than two edges, of support 3.
void give_clique(int node, int& next, BitGraph& graph) {
  const Indices clique{node, next, next + 1, next + 2, next + 3};
  for (const int a : clique)
    for (const int b : clique)
      if (a < b) graph.connect(a, b);
  next += 4;
}

/// Two triangles share an edge; without their edges at one node, the others there support nothing.
TEST(EdgeSupport, EdgesThatAreGoneSupportNoLaterBlock) {
  constexpr int kNode = 1000;  // in another block than 0 and 1
  BitGraph graph = testing::graph_of(1200, {{0, 1}, {0, kNode}, {1, kNode}, {0, kNode + 1}, {1, kNode + 1}});
  int next = 100;
  for (const int node : {0, 1, kNode, kNode + 1}) give_clique(node, next, graph);
  ASSERT_EQ(support(graph, 0, 1), 2);
  EdgeSupport edges(graph);
  edges.remove_below(2, {kNode});
  EXPECT_FALSE(graph.is_edge(kNode, 0) || graph.is_edge(1, kNode));
  EXPECT_TRUE(graph.is_edge(0, 1) && graph.is_edge(0, kNode + 1));
  edges.remove_below(2, {1});
  EXPECT_FALSE(graph.is_edge(0, 1));
}

TEST(EdgeSupport, ANodeThatHasLostItsEdgesLosesTheRest) {
  constexpr int kNode = 600;
  BitGraph graph = testing::graph_of(1200, {{0, kNode}, {1, kNode}, {2, kNode}, {kNode, 1000}, {kNode, 1001}});
  int next = 100;
  for (const int node : {0, 1, 2, 1000, 1001}) give_clique(node, next, graph);
  EdgeSupport edges(graph);
  edges.remove_below(2, {kNode});
  EXPECT_EQ(graph.degree(kNode), 2) << "to nodes of larger number";
  edges.remove_below(2, {1000});
  EXPECT_EQ(graph.degree(kNode), 0);
  EXPECT_EQ(graph.degree(1000), 4);
}

/// A tail has ever fewer edges once its end is gone: all of it goes, though no node of it is given, and the clique stays.
TEST(EdgeSupport, NodesOfFewEdgesLoseThemAll) {
  constexpr int kClique = 5, kEnd = 700;
  BitGraph graph(kEnd + 3);
  graph.connect(kEnd + 1, kEnd + 2);
  for (int a = 0; a < kClique; ++a)
    for (int b = 0; b < a; ++b) graph.connect(a, b);
  for (int node = kClique; node <= kEnd; ++node)
    for (int other = std::max(node - 3, kClique - 1); other < node; ++other) graph.connect(node, other);
  ASSERT_EQ(graph.degree(300), 6);
  EdgeSupport(graph).remove_below(kClique - 2, {0});
  for (int a = 0; a < graph.size(); ++a) EXPECT_EQ(graph.degree(a), a < kClique ? kClique - 1 : 0) << a;
}

TEST(EdgeSupport, OfNoNodesNothing) {
  BitGraph graph(0);
  EdgeSupport(graph).remove_below(5, {});
  BitGraph pair = testing::graph_of(2, {{0, 1}});
  EdgeSupport(pair).remove_below(5, {});
  EXPECT_TRUE(pair.is_edge(0, 1));
}

}  // namespace
}  // namespace corral
