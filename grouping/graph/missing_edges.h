// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "grouping/graph/bit_graph.h"

namespace corral {

/// The nodes that each node of a graph is not connected to, itself left out, where these are few: one for eight words of its bits
/// on average. Loops over them then take less time than loops over words.
class MissingEdges {
 public:
  explicit MissingEdges(const BitGraph& graph);

  /// Bytes for a graph of so many nodes.
  static double memory(int nodes) { return BitGraph::memory(nodes) / 16 + 17.0 * nodes; }

  /// Whether they are few.
  bool are_listed() const { return !starts_.empty(); }

  /// One bit for each node: whether it has some.
  const std::vector<BitGraph::Word>& with_some() const { return with_some_; }

  /// Those of a node, ascending.
  const int* begin(int node) const { return others_.data() + starts_[static_cast<std::size_t>(node)]; }
  const int* end(int node) const { return others_.data() + starts_[static_cast<std::size_t>(node) + 1]; }

 private:
  std::vector<std::size_t> starts_;
  Indices others_;
  std::vector<BitGraph::Word> with_some_;
};

}  // namespace corral
