// SPDX-License-Identifier: MIT
#include "grouping/graph/missing_edges.h"

namespace corral {

MissingEdges::MissingEdges(const BitGraph& graph) {
  constexpr std::size_t kWordsForOne = 8;
  std::size_t missing = 0;
  for (int node = 0; node < graph.size(); ++node)
    missing += static_cast<std::size_t>(graph.size() - 1 - graph.degree(node));
  if (missing * kWordsForOne > static_cast<std::size_t>(graph.size()) * static_cast<std::size_t>(graph.words())) return;
  starts_.reserve(static_cast<std::size_t>(graph.size()) + 1);
  others_.reserve(missing);
  with_some_.resize(static_cast<std::size_t>(graph.words()));
  for (int node = 0; node < graph.size(); ++node) {
    starts_.push_back(others_.size());
    for (int word = 0; word < graph.words(); ++word) {
      BitGraph::Word absent = ~graph.neighbors(node)[word];
      if (word == graph.size() / 64) absent &= (BitGraph::Word{1} << graph.size() % 64) - 1;
      BitGraph::for_bits(&absent, 1, [&](int bit) {
        if (64 * word + bit != node) others_.push_back(64 * word + bit);
      });
    }
    if (others_.size() > starts_.back())
      with_some_[static_cast<std::size_t>(node >> 6)] |= BitGraph::Word{1} << (node & 63);
  }
  starts_.push_back(others_.size());
}

}  // namespace corral
