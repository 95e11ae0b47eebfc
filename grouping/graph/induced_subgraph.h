// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/graph/bit_graph.h"

namespace corral {

/// Graphs on some of the nodes of one graph, with the edges that it has between them.
class InducedSubgraphs {
 public:
  /// `graph` must outlive it.
  explicit InducedSubgraphs(const BitGraph& graph);

  /// Bytes for a graph of so many nodes, beside those of the subgraphs.
  static double memory(int nodes) { return 4.0 * nodes + nodes / 8.0; }

  /// Node k of the subgraph is nodes[k]; each may occur once.
  BitGraph operator()(const Indices& nodes);

 private:
  void add_row(const BitGraph::Word* neighbors, int k, BitGraph& subgraph) const;

  const BitGraph& graph_;
  Indices places_;                      ///< of a node in the list
  std::vector<BitGraph::Word> chosen_;  ///< the nodes of the list
};

}  // namespace corral
