// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_support.h"

#include <algorithm>

namespace corral {

EdgeSupport::EdgeSupport(BitGraph& graph) : graph_(graph) {
  for (int node = 0; node < graph.size(); ++node) degrees_.push_back(graph.degree(node));
}

double EdgeSupport::memory(int nodes) {
  return BitGraph::memory_of_block(nodes, 1.0 * BitGraph::kNodesOfBlock * nodes) + 12.0 * nodes + 64;
}

void EdgeSupport::remove_below(int least, const Indices& nodes) {
  std::vector<int> supports;
  for (auto node = nodes.begin(); node != nodes.end();) {
    remove_small_nodes(least);
    BitGraph::NodeBlock block;
    block.first = *node / 64;
    block.last = std::min(block.first + BitGraph::kBlock, graph_.words());
    block.nodes.assign(BitGraph::kBlock, 0);
    block.wanted.assign(static_cast<std::size_t>(graph_.size()), 1);
    for (; node != nodes.end() && *node < 64 * block.last; ++node)
      block.nodes[static_cast<std::size_t>(*node / 64 - block.first)] |= BitGraph::Word{1} << *node % 64;
    const BitGraph::BlockEdges edges(graph_, block, BitGraph::Others::InFront);
    graph_.count_common(edges, least, supports);
    auto support = supports.begin();
    edges.for_each([&](int i, int j) {
      if (*support++ < least) disconnect(i, j);
    });
  }
}

void EdgeSupport::disconnect(int a, int b) {
  graph_.disconnect(a, b);
  --degrees_[static_cast<std::size_t>(a)], --degrees_[static_cast<std::size_t>(b)];
}

void EdgeSupport::remove_small_nodes(int least) {
  Indices small, neighbors;
  const auto is_small = [&](int node) { return degrees_[static_cast<std::size_t>(node)] <= least; };
  for (int node = 0; node < graph_.size(); ++node)
    if (degrees_[static_cast<std::size_t>(node)] > 0 && is_small(node)) small.push_back(node);
  while (!small.empty()) {
    const int node = small.back();
    small.pop_back();
    neighbors.clear();
    graph_.for_neighbors(node, [&](int other) { neighbors.push_back(other); });
    for (const int other : neighbors) {
      const bool was_small = is_small(other);
      disconnect(node, other);
      if (!was_small && is_small(other)) small.push_back(other);
    }
  }
}

}  // namespace corral
