// SPDX-License-Identifier: MIT
#include "grouping/graph/max_clique.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "grouping/graph/core_numbers.h"
#include "grouping/graph/maximal_cliques.h"
#include "tests/support/random_graphs.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kEnough = 1000000;

std::vector<Indices> all_largest(const BitGraph& graph) {
  MaxCliqueSearch search(graph);
  const Indices first = search.find_one(kEnough).value();
  std::vector<Indices> found;
  EXPECT_TRUE(
      search.visit_all(static_cast<int>(first.size()), kEnough, [&](const Indices& each) { found.push_back(each); }));
  EXPECT_NE(std::find(found.begin(), found.end(), first), found.end());
  std::sort(found.begin(), found.end());
  return found;
}

TEST(MaxClique, AreThoseOfAnExhaustiveSearch) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    RandomStream random(seed);
    const BitGraph graph = testing::random_graph(random, 1 + static_cast<int>(random.below(14)), random.uniform());
    std::vector<Indices> expected = testing::maximal_cliques_by_trial(graph);
    const std::size_t size = std::max_element(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
                               return a.size() < b.size();
                             })->size();
    expected.erase(
        std::remove_if(expected.begin(), expected.end(), [&](const Indices& clique) { return clique.size() < size; }),
        expected.end());
    ASSERT_EQ(all_largest(graph), expected) << "seed " << seed;
  }
}

/// An octahedron has a larger core than the clique of four beside it.
TEST(MaxClique, IsNotTheLargestCore) {
  BitGraph graph(10);
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < a; ++b)
      if (a / 2 != b / 2) graph.connect(a, b);
  for (int a = 6; a < 10; ++a)
    for (int b = 6; b < a; ++b) graph.connect(a, b);
  EXPECT_THAT(core_numbers(graph).numbers, ElementsAre(4, 4, 4, 4, 4, 4, 3, 3, 3, 3));
  EXPECT_THAT(all_largest(graph), ElementsAre(ElementsAre(6, 7, 8, 9)));
}

TEST(MaxClique, OfMoreNodesThanAWordHolds) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomStream random(seed);
    BitGraph graph = testing::random_graph(random, 300, 0.3);
    Indices planted;
    for (int k = 0; k < 70; ++k) planted.push_back(4 * k + 3);
    for (const int a : planted)
      for (const int b : planted)
        if (a < b) graph.connect(a, b);
    ASSERT_EQ(all_largest(graph), std::vector<Indices>{planted});
  }
}

/// Where edges in few triangles are removed first.
TEST(MaxClique, OfALargeSparseGraph) {
  constexpr int kClique = 90, kStep = 95;
  RandomStream random(2);
  BitGraph graph = testing::random_graph(random, kClique * kStep, 0.015);
  std::vector<Indices> planted(2);
  for (int k = 0; k < kClique; ++k)
    for (std::size_t each : {0, 1}) planted[each].push_back(kStep * k + 40 * static_cast<int>(each));
  for (const Indices& clique : planted)
    for (const int a : clique)
      for (const int b : clique)
        if (a < b) graph.connect(a, b);
  EXPECT_EQ(all_largest(graph), planted);
}

/// Where the edges that are missing are listed.
TEST(MaxClique, OfGraphsThatLackFewEdgesAreTheLargestMaximalOnes) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    RandomStream random(seed);
    BitGraph graph(700 + static_cast<int>(seed));
    for (int a = 0; a < 600; ++a)
      for (int b = 0; b < a; ++b) graph.connect(a, b);
    for (int edge = 0; edge < 400; ++edge)
      graph.disconnect(static_cast<int>(random.below(12)), static_cast<int>(random.below(12)));
    for (int edge = 0; edge < 5; ++edge)
      graph.disconnect(static_cast<int>(random.below(600)), static_cast<int>(random.below(600)));
    for (int a = 600; a < graph.size(); ++a)
      for (int edge = 0; edge < 50; ++edge) graph.connect(a, static_cast<int>(random.below(600)));
    std::vector<Indices> expected;
    visit_maximal_cliques(graph, 3, kEnough, [&](const Indices& clique) {
      if (!expected.empty() && clique.size() < expected[0].size()) return;
      if (!expected.empty() && clique.size() > expected[0].size()) expected.clear();
      expected.push_back(clique);
      std::sort(expected.back().begin(), expected.back().end());
    });
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(all_largest(graph), expected) << "seed " << seed;
  }
}

TEST(MaxClique, AddingAnEdgeNeverShrinksIt) {
  RandomStream random(3);
  BitGraph graph(60);
  std::size_t last = 1;
  for (int edge = 0; edge < 1200; ++edge) {
    const int a = static_cast<int>(random.below(60)), b = static_cast<int>(random.below(60));
    if (a == b) continue;
    graph.connect(a, b);
    const Indices clique = MaxCliqueSearch(graph).find_one(kEnough).value();
    ASSERT_GE(clique.size(), last);
    ASSERT_TRUE(testing::is_clique(graph, clique) && testing::is_maximal(graph, clique));
    const Indices numbers = core_numbers(graph).numbers;
    ASSERT_LE(clique.size(), static_cast<std::size_t>(*std::max_element(numbers.begin(), numbers.end()) + 1));
    last = clique.size();
  }
}

TEST(MaxClique, OfGraphsWithoutEdges) {
  EXPECT_THAT(MaxCliqueSearch(BitGraph(0)).find_one(kEnough).value(), IsEmpty());
  EXPECT_THAT(MaxCliqueSearch(BitGraph(5)).find_one(kEnough).value(), SizeIs(1));
  EXPECT_THAT(all_largest(BitGraph(5)), SizeIs(5));
}

TEST(MaxClique, WorkOfColoringIsBounded) {
  RandomStream random(1);
  const BitGraph hard = testing::random_graph(random, 120, 0.7);
  MaxCliqueSearch search(hard), frugal(hard, 1);
  const Indices clique = search.find_one(kEnough).value();
  const std::int64_t steps = search.steps();
  EXPECT_FALSE(frugal.find_one(steps));
  EXPECT_LT(frugal.steps(), steps);
  EXPECT_EQ(frugal.find_one(1000 * steps), clique);
}

TEST(MaxClique, StepsAreBounded) {
  const BitGraph graph = testing::moon_moser_graph(6);
  MaxCliqueSearch search(graph);
  ASSERT_TRUE(search.find_one(kEnough));
  int visited = 0;
  EXPECT_TRUE(search.visit_all(6, kEnough, [&](const Indices&) { ++visited; }));
  EXPECT_EQ(visited, 729);
  const std::int64_t steps = search.steps();
  EXPECT_TRUE(search.visit_all(6, steps, [](const Indices&) {}));
  visited = 0;
  EXPECT_FALSE(search.visit_all(6, steps - 1, [&](const Indices&) { ++visited; }));
  EXPECT_LT(visited, 729);
  visited = 0;
  EXPECT_TRUE(search.visit_all(6, kEnough, [&](const Indices&) { ++visited; }));  // and it can be used again
  EXPECT_EQ(visited, 729);

  RandomStream random(1);
  const BitGraph hard = testing::random_graph(random, 120, 0.7);
  MaxCliqueSearch bounded(hard);
  EXPECT_FALSE(bounded.find_one(1));
  ASSERT_TRUE(bounded.find_one(kEnough));
  const std::int64_t needed = bounded.steps();
  EXPECT_TRUE(bounded.find_one(needed));
  EXPECT_FALSE(bounded.find_one(needed - 1));
}

}  // namespace
}  // namespace corral
