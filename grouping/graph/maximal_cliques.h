// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "grouping/graph/bit_graph.h"

namespace corral {

/// Calls visit(clique) for every clique of at least `smallest` nodes that no node extends, each once. Its nodes are in the order
/// in which they were put into it: one clique and the next begin alike as far as the search has not gone back.
///
/// For each node in the order of core_numbers() the cliques are searched in which it is the first that is removed: with P its
/// later and X its earlier neighbours, a clique is complete where P and X are both empty, and only nodes of P are tried that
/// are no neighbours of a pivot, the node of P or X with the most neighbours in P (ties: the lowest core number first).
/// Source    [bron1973algorithm], [tomita2006worst] (pivot), [eppstein2010listing] (order).
/// Returns   the recursive calls; absent if it was left after `max_steps` of them.
/// Cost      O(3^(k/3) M k) for the largest core number k; no clique is stored.
std::optional<std::int64_t> visit_maximal_cliques(const BitGraph& graph, int smallest, std::int64_t max_steps,
                                                  const std::function<void(const Indices&)>& visit);

/// Bytes for so many nodes, beside the graph.
double maximal_cliques_memory(int nodes);

}  // namespace corral
