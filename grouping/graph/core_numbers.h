// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/graph/bit_graph.h"

namespace corral {

/// The k-core of a graph is its largest subgraph in which every node has k neighbours or more; the core number of a node is
/// the largest k of a core that holds it. Removing a node of the smallest degree, time and again, finds them all:
///
///   numbers[v] = the largest degree at which a node was removed up to v
///
/// In the order of removal (degeneracy order) a node has at most as many later neighbours as its number says, and numbers
/// never fall. A clique of s nodes lies in the (s-1)-core.
/// Source    [batagelj2003algorithm].
/// Cost      O(M^2 / 64 + edges); of a node with more than half of those left, the pairs that are none instead.
struct CoreNumbers {
  Indices numbers;
  Indices order;  ///< the nodes as they are removed
};
CoreNumbers core_numbers(const BitGraph& graph);

}  // namespace corral
