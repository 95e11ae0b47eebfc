// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_support.h"

#include <algorithm>

namespace corral {

void remove_edges_below_support(BitGraph& graph, const Indices& nodes, int least) {
  std::vector<int> supports;
  for (auto node = nodes.begin(); node != nodes.end();) {
    BitGraph::NodeBlock block;
    block.first = *node / 64;
    block.last = std::min(block.first + BitGraph::kBlock, graph.words());
    block.nodes.assign(BitGraph::kBlock, 0);
    block.wanted.assign(static_cast<std::size_t>(graph.size()), 1);
    for (; node != nodes.end() && *node < 64 * block.last; ++node)
      block.nodes[static_cast<std::size_t>(*node / 64 - block.first)] |= BitGraph::Word{1} << *node % 64;
    const BitGraph::BlockEdges edges(graph, block, BitGraph::Others::InFront);
    graph.count_common(edges, least, supports);
    auto support = supports.begin();
    edges.for_each([&](int i, int j) {
      if (*support++ < least) graph.disconnect(i, j);
    });
  }
}

double edge_support_memory(int nodes) {
  return BitGraph::memory_of_block(nodes, 1.0 * BitGraph::kNodesOfBlock * nodes) + 64;
}

}  // namespace corral
