// SPDX-License-Identifier: MIT
#include "grouping/graph/bit_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "grouping/columns/compatibility.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(BitGraph, NeighborsComeInOrder) {
  BitGraph graph(200);
  for (const int other : {150, 3, 63, 64, 199}) graph.connect(100, other);
  Indices seen;
  graph.for_neighbors(100, [&](int node) { seen.push_back(node); });
  EXPECT_THAT(seen, ElementsAre(3, 63, 64, 150, 199));
  EXPECT_EQ(graph.degree(100), 5);
  EXPECT_EQ(graph.degree(100, 1, 3), 2);
  EXPECT_TRUE(graph.is_edge(199, 100));
  graph.disconnect(199, 100);
  EXPECT_FALSE(graph.is_edge(100, 199) || graph.is_edge(199, 100));
}

TEST(BitGraph, EveryBitIsFound) {
  BitGraph graph(65);
  for (int node = 0; node < 64; ++node) {
    graph.connect(64, node);
    Indices seen;
    graph.for_neighbors(64, [&](int other) { seen.push_back(other); });
    EXPECT_THAT(seen, ElementsAre(node));
    graph.disconnect(64, node);
  }
}

TEST(ConsistencyGraph, IsThatOfThePlainForm) {
  for (const int rows : {0, 1, 2, 63, 64, 65, 130, 300})
    for (const double shortest : {-1.0, 40.0}) {
      const CorrespondenceSet table = testing::harsh_table(rows, 0.4, 7);
      const BitGraph graph = consistency_graph(table, 2, shortest);
      Indices others;
      for (int j = 0; j < rows; ++j) others.push_back(j);
      Indices common(others.size());
      for (int i = 0; i < rows; ++i) {
        int degree = 0;
        for (int j = 0; j < rows; ++j) {
          const PairDistances lengths = pair_distances(table, i, j);
          const bool expected =
              i != j && std::abs(lengths.source - lengths.target) < 2 && lengths.source + lengths.target > shortest;
          ASSERT_EQ(graph.is_edge(i, j), expected) << i << " " << j;
          degree += expected;
        }
        EXPECT_EQ(graph.degree(i), degree);
        graph.count_common(i, others, common.data());
        for (int j = 0; j < rows; ++j) {
          int expected = 0;
          for (int k = 0; k < rows; ++k) expected += graph.is_edge(i, k) && graph.is_edge(j, k);
          ASSERT_EQ(common[static_cast<std::size_t>(j)], expected);
        }
      }
    }
}

TEST(BitGraph, CommonNeighboursOfABlockAreThoseOfItsEdges) {
  constexpr int kLeast = 300;
  const CorrespondenceSet table = testing::harsh_table(1300, 0.4, 7);
  const BitGraph graph = consistency_graph(table, 6);
  for (const int first : {0, 5, 16})
    for (const auto side : {BitGraph::Others::Behind, BitGraph::Others::InFront}) {
      const bool is_behind = side == BitGraph::Others::Behind;
      BitGraph::NodeBlock block{first, std::min(first + BitGraph::kBlock, graph.words()), {}, {}};
      for (int word = 0; word < BitGraph::kBlock; ++word) block.nodes.push_back(0x5555FFFF0000AAAA);
      for (int j = 0; j < 1250; ++j) block.wanted.push_back(j % 3 != 0);
      const BitGraph::BlockEdges edges(graph, block, side);
      std::vector<int> counts, bounded;
      graph.count_common(edges, 0, counts);
      graph.count_common(edges, kLeast, bounded);
      std::size_t edge = 0;
      int fewer = 0;
      std::set<std::pair<int, int>> seen;
      edges.for_each([&](int i, int j) {
        Indices common(1);
        graph.count_common(i, {j}, common.data());
        ASSERT_EQ(counts.at(edge), common[0]) << i << " " << j;
        if (common[0] >= kLeast) {
          ASSERT_EQ(bounded.at(edge), common[0]) << i << " " << j;
        } else {
          ASSERT_LT(bounded.at(edge), kLeast) << i << " " << j;
          ++fewer;
        }
        ++edge;
        seen.emplace(i, j);
      });
      EXPECT_EQ(edge, counts.size());
      EXPECT_EQ(edge, edges.size());
      EXPECT_TRUE(fewer > 100 && fewer + 100 < static_cast<int>(edge)) << fewer;
      std::set<std::pair<int, int>> expected;
      for (int i = 64 * first; i < std::min(64 * block.last, graph.size()); ++i)
        for (int j = 0; j < 1250; ++j)
          if (j % 3 != 0 && (is_behind ? j > i : j < i) && graph.is_edge(i, j) &&
              (0x5555FFFF0000AAAA >> (i % 64) & 1) != 0)
            expected.emplace(i, j);
      EXPECT_EQ(seen, expected);
      EXPECT_GT(seen.size(), 500u);
    }
}

TEST(SampledDegrees, CountTheRowsAtEvenSteps) {
  for (const int rows : {1, 64, 65, 300}) {
    const CorrespondenceSet table = testing::harsh_table(rows, 0.4, 7);
    const Indices degrees = sampled_degrees(table, 2, 40, 3);
    for (int j = 0; j < rows; ++j) {
      int expected = 0;
      for (const int i : {0, rows / 3, 2 * rows / 3}) {
        const PairDistances lengths = pair_distances(table, i, j);
        expected += std::abs(lengths.source - lengths.target) < 2 && lengths.source + lengths.target > 40;
      }
      EXPECT_EQ(degrees[static_cast<std::size_t>(j)], expected) << j;
    }
  }
}

}  // namespace
}  // namespace corral
