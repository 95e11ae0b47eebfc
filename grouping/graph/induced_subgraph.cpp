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
  for (int k = 0; k < subgraph.size(); ++k) {
    const BitGraph::Word* neighbors = graph_.neighbors(nodes[static_cast<std::size_t>(k)]);
    for (int word = 0; word < graph_.words(); ++word) {
      const BitGraph::Word shared = neighbors[word] & chosen_[static_cast<std::size_t>(word)];
      BitGraph::for_bits(&shared, 1, [&](int bit) {
        const int place = places_[static_cast<std::size_t>(64 * word + bit)];
        if (place > k) subgraph.connect(k, place);
      });
    }
  }
  return subgraph;
}

}  // namespace corral
