// SPDX-License-Identifier: MIT
#pragma once

// Small graphs, and their cliques by trying every set of nodes.

#include <algorithm>
#include <utility>
#include <vector>

#include "grouping/graph/bit_graph.h"
#include "kernel/random.h"

namespace corral::testing {

inline BitGraph graph_of(int nodes, const std::vector<std::pair<int, int>>& edges) {
  BitGraph graph(nodes);
  for (const auto& [a, b] : edges) graph.connect(a, b);
  return graph;
}

inline BitGraph random_graph(RandomStream& random, int nodes, double density) {
  BitGraph graph(nodes);
  for (int a = 0; a < nodes; ++a)
    for (int b = 0; b < a; ++b)
      if (random.uniform() < density) graph.connect(a, b);
  return graph;
}

/// Groups of three nodes; two nodes are connected unless they are in one group: 3^groups maximal cliques.
inline BitGraph moon_moser_graph(int groups) {
  BitGraph graph(3 * groups);
  for (int a = 0; a < graph.size(); ++a)
    for (int b = 0; b < a; ++b)
      if (a / 3 != b / 3) graph.connect(a, b);
  return graph;
}

inline bool is_clique(const BitGraph& graph, const Indices& nodes) {
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a + 1; b < nodes.size(); ++b)
      if (!graph.is_edge(nodes[a], nodes[b])) return false;
  return true;
}

inline bool is_maximal(const BitGraph& graph, const Indices& clique) {
  for (int node = 0; node < graph.size(); ++node) {
    bool extends = true;
    for (const int member : clique) extends = extends && node != member && graph.is_edge(node, member);
    if (extends) return false;
  }
  return true;
}

/// Every set of nodes that is a clique and that no node extends; for graphs of few nodes. In the order of lists.
inline std::vector<Indices> maximal_cliques_by_trial(const BitGraph& graph) {
  std::vector<Indices> cliques;
  for (BitGraph::Word set = 1; set < BitGraph::Word{1} << graph.size(); ++set) {
    Indices nodes;
    bool is_maximal_clique = true;  // a node belongs to it if and only if all others of it are its neighbours
    for (int node = 0; node < graph.size(); ++node) {
      const BitGraph::Word itself = BitGraph::Word{1} << node;
      if ((set & itself) != 0) nodes.push_back(node);
      is_maximal_clique =
          is_maximal_clique && ((set & itself) != 0) == ((set & ~itself & ~*graph.neighbors(node)) == 0);
    }
    if (is_maximal_clique) cliques.push_back(nodes);
  }
  std::sort(cliques.begin(), cliques.end());
  return cliques;
}

}  // namespace corral::testing
