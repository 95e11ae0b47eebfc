// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/graph/bit_graph.h"

namespace corral {

/// Removes edges of a graph that are in no clique of s nodes. The support of an edge is the number of common neighbours of its
/// ends, that is, of triangles that it is in: in such a clique every edge has s - 2 or more, and every node s - 1 edges.
/// Source    [cohen2008trusses], one pass.
/// Cost      O(M edges / 64) time, in blocks (BitGraph::NodeBlock).
class EdgeSupport {
 public:
  /// `graph` must outlive it, and change by it alone.
  explicit EdgeSupport(BitGraph& graph);

  /// Bytes for a graph of so many nodes.
  static double memory(int nodes);

  /// Removes, from the given nodes, ascending, to those of smaller number, the edges whose support is less than `least`; before
  /// each block, all edges of nodes that have no more than `least`. Removed edges do not support those of later blocks.
  void remove_below(int least, const Indices& nodes);

 private:
  void disconnect(int a, int b);
  void remove_small_nodes(int least);

  BitGraph& graph_;
  Indices degrees_;
};

}  // namespace corral
