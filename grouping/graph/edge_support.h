// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/graph/bit_graph.h"

namespace corral {

/// Removes edges whose support is less than `least`: those from the given nodes, ascending, to nodes of smaller number. The support
/// of an edge is the number of common neighbours of its ends, that is, of triangles that it is in. In a clique of s nodes every edge has
/// s - 2 or more: with `least` up to that, no clique of s nodes loses one. Removed edges do not support those of later blocks.
/// Source    [cohen2008trusses], one pass.
/// Cost      O(M edges / 64) time, in blocks (BitGraph::NodeBlock).
void remove_edges_below_support(BitGraph& graph, const Indices& nodes, int least);

/// Bytes for a graph of so many nodes.
double edge_support_memory(int nodes);

}  // namespace corral
