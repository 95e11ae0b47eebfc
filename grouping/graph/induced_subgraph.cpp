// SPDX-License-Identifier: MIT
#include "grouping/graph/induced_subgraph.h"

#include <algorithm>

namespace corral {

InducedSubgraphs::InducedSubgraphs(const BitGraph& graph)
    : graph_(graph),
      places_(static_cast<std::size_t>(graph.size())),
      chosen_(static_cast<std::size_t>(graph.words())) {}

BitGraph InducedSubgraphs::operator()(const Indices& nodes) {
  std::fill(chosen_.begin(), chosen_.end(), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    places_[static_cast<std::size_t>(nodes[k])] = static_cast<int>(k);
    chosen_[static_cast<std::size_t>(nodes[k] >> 6)] |= BitGraph::Word{1} << (nodes[k] & 63);
  }
  BitGraph subgraph(static_cast<int>(nodes.size()));
  for (int k = 0; k < subgraph.size(); ++k) add_row(graph_.neighbors(nodes[static_cast<std::size_t>(k)]), k, subgraph);
  return subgraph;
}

/// By the edges, or by those that are missing where these are fewer.
void InducedSubgraphs::add_row(const BitGraph::Word* neighbors, int k, BitGraph& subgraph) const {
  const bool has_most = 2 * BitGraph::count_in_both(neighbors, chosen_.data(), graph_.words()) > subgraph.size();
  if (has_most)
    for (int other = 0; other < subgraph.size(); other += 64)
      subgraph.bits_[subgraph.start(k) + static_cast<std::size_t>(other / 64)] =
          subgraph.size() - other < 64 ? (BitGraph::Word{1} << (subgraph.size() - other)) - 1 : ~BitGraph::Word{0};
  for (std::size_t word = 0; word < chosen_.size(); ++word) {
    const BitGraph::Word named = (has_most ? ~neighbors[word] : neighbors[word]) & chosen_[word];
    BitGraph::for_bits(&named, 1, [&](int bit) {
      const int place = places_[64 * word + static_cast<std::size_t>(bit)];
      has_most ? subgraph.clear(k, place) : subgraph.set(k, place);
    });
  }
}

}  // namespace corral
