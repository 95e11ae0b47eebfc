// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "grouping/graph/bit_graph.h"

namespace corral {

/// How many neighbours a node of a graph has in common with each of many others.
///
/// With H the nodes that have more than half as many neighbours as any has, for a node i
///
///   | N(i) & N(j) | = | H & N(j) | + | { k in N(i), not in H : j in N(k) } | - | { k in H, not in N(i) : j in N(k) } |
///
/// so that the rows of bits of those k alone are added up, which are few where the graph is a dense part and little else. Where
/// they are more than N(i), the rows of N(i) are added up; of a sparse graph BitGraph::count_common() is faster then.
class CommonNeighbors {
 public:
  /// `graph` must outlive it.
  explicit CommonNeighbors(const BitGraph& graph);

  /// Bytes for a graph of so many nodes.
  static double memory(int nodes) { return 20.125 * nodes + 2048 + kSlices * kChunk * sizeof(BitGraph::Word); }

  int degree(int node) const { return degrees_[static_cast<std::size_t>(node)]; }

  /// Whether count() takes less time than BitGraph::count_common() with so many others.
  bool is_faster(int node, int first, int last, int others) const;

  /// counts[j - 64 first] for the nodes j whose bits are in the words from `first` to before `last`, up to the next call.
  /// Plain form  BitGraph::count_common
  const std::vector<int>& count(int node, int first, int last);

  /// One bit for each of those, whether its count is `fewest` or more, which is above 0.
  void find(int fewest, std::vector<BitGraph::Word>& found) const;

  static constexpr int kChunk = 128;  ///< words that are added up together
  static constexpr int kSlices = 12;  ///< digits of their sums before these are written

 private:
  const BitGraph& graph_;
  Indices degrees_, in_dense_;         ///< |N(j)|, |H & N(j)|
  std::vector<BitGraph::Word> dense_;  ///< H
  int dense_nodes_ = 0;                ///< |H|
  Indices added_, removed_;
  std::vector<int> counts_;
};

}  // namespace corral
