// SPDX-License-Identifier: MIT
#include "grouping/graph/missing_edges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random_graphs.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(MissingEdges, AreListedInOrderWhereTheyAreFew) {
  RandomStream random(3);
  BitGraph graph = testing::random_graph(random, 1000, 1);
  for (const int other : {999, 3, 64, 63}) graph.disconnect(500, other);
  const MissingEdges missing(graph);
  ASSERT_TRUE(missing.are_listed());
  EXPECT_THAT(Indices(missing.begin(500), missing.end(500)), ElementsAre(3, 63, 64, 999));
  EXPECT_THAT(Indices(missing.begin(999), missing.end(999)), ElementsAre(500));
  EXPECT_EQ(missing.begin(0), missing.end(0));
  for (int node = 0; node < 1000; ++node)
    EXPECT_EQ(missing.with_some()[static_cast<std::size_t>(node / 64)] >> node % 64 & 1,
              missing.begin(node) != missing.end(node));
  EXPECT_FALSE(MissingEdges(testing::random_graph(random, 1000, 0.99)).are_listed());
}

}  // namespace
}  // namespace corral
