// SPDX-License-Identifier: MIT
#include "grouping/graph/maximal_cliques.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kEnough = 1000000;

std::vector<Indices> maximal_cliques(const BitGraph& graph, int smallest = 1) {
  std::vector<Indices> found;
  EXPECT_TRUE(visit_maximal_cliques(graph, smallest, kEnough, [&](const Indices& clique) {
    found.push_back(clique);
    std::sort(found.back().begin(), found.back().end());
  }));
  std::sort(found.begin(), found.end());
  return found;
}

TEST(MaximalCliques, AreThoseOfAnExhaustiveSearch) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    RandomStream random(seed);
    const BitGraph graph = testing::random_graph(random, 1 + static_cast<int>(random.below(14)), random.uniform());
    std::vector<Indices> expected = testing::maximal_cliques_by_trial(graph);
    ASSERT_EQ(maximal_cliques(graph), expected) << "seed " << seed;
    expected.erase(std::remove_if(expected.begin(), expected.end(), [](const Indices& c) { return c.size() < 3; }),
                   expected.end());
    ASSERT_EQ(maximal_cliques(graph, 3), expected) << "seed " << seed;
  }
}

TEST(MaximalCliques, OfACompleteGraphIsOne) {
  BitGraph graph(60);
  for (int a = 0; a < 60; ++a)
    for (int b = 0; b < a; ++b) graph.connect(a, b);
  Indices all(60);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_THAT(maximal_cliques(graph), ElementsAre(all));
}

TEST(MaximalCliques, OfGroupsOfThree) {
  int count = 0;
  const auto visit = [&](const Indices& clique) { count += clique.size() == 10; };
  const BitGraph graph = testing::moon_moser_graph(10);
  const auto steps = visit_maximal_cliques(graph, 3, kEnough, visit);
  ASSERT_TRUE(steps);
  EXPECT_EQ(count, 59049);
  EXPECT_TRUE(visit_maximal_cliques(graph, 3, *steps, visit));
  EXPECT_FALSE(visit_maximal_cliques(graph, 3, *steps - 1, visit));
  count = 0;
  EXPECT_FALSE(visit_maximal_cliques(graph, 3, *steps / 2, visit));
  EXPECT_LT(count, 59049);
}

TEST(MaximalCliques, OfMoreNodesThanAWordHolds) {
  RandomStream random(5);
  const BitGraph graph = testing::random_graph(random, 300, 0.1);
  std::vector<Indices> cliques = maximal_cliques(graph);
  for (const Indices& clique : cliques)
    ASSERT_TRUE(testing::is_clique(graph, clique) && testing::is_maximal(graph, clique));
  EXPECT_EQ(std::unique(cliques.begin(), cliques.end()), cliques.end());
  std::vector<char> is_in_one(300, 0);
  for (const Indices& clique : cliques)
    for (const int node : clique) is_in_one[static_cast<std::size_t>(node)] = 1;
  EXPECT_THAT(is_in_one, ::testing::Each(1));
}

TEST(MaximalCliques, OfNothing) {
  EXPECT_THAT(maximal_cliques(BitGraph(0)), IsEmpty());
  EXPECT_THAT(maximal_cliques(BitGraph(2)), ElementsAre(ElementsAre(0), ElementsAre(1)));
}

}  // namespace
}  // namespace corral
