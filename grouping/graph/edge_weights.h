// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "grouping/graph/bit_graph.h"

namespace corral {

/// A graph with a number for each edge, the same in both directions.
class EdgeWeights {
 public:
  /// All weights are 0.
  explicit EdgeWeights(const BitGraph& graph);

  /// Bytes for so many nodes, all of them connected, with path_sums().
  static double memory(int nodes) { return 20.0 * nodes * nodes + 32.0 * nodes; }

  int size() const { return static_cast<int>(starts_.size()) - 1; }

  /// Calls visit(neighbour, weight) for every edge of a node, ascending.
  template <class Visit>
  void for_edges(int node, Visit&& visit) const {
    for (std::size_t edge = begin(node); edge < end(node); ++edge) visit(neighbors_[edge], weights_[edge]);
  }

  /// Of an edge that is there.
  double weight(int a, int b) const {
    const auto first = neighbors_.begin();
    const auto found =
        std::lower_bound(first + static_cast<std::ptrdiff_t>(begin(a)), first + static_cast<std::ptrdiff_t>(end(a)), b);
    return weights_[static_cast<std::size_t>(found - first)];
  }

  /// weight = value(node, neighbour, weight), which must be symmetric in the nodes.
  template <class Value>
  void replace_each(Value&& value) {
    for (int node = 0; node < size(); ++node)
      for (std::size_t edge = begin(node); edge < end(node); ++edge)
        weights_[edge] = value(node, neighbors_[edge], weights_[edge]);
  }

  /// W_ij sum_k W_ik W_jk over the common neighbours, in the order of the edges.
  std::vector<double> path_sums() const;
  void set(std::vector<double> weights) { weights_ = std::move(weights); }

 private:
  std::size_t begin(int node) const { return starts_[static_cast<std::size_t>(node)]; }
  std::size_t end(int node) const { return starts_[static_cast<std::size_t>(node) + 1]; }
  double product(const std::vector<double>& row, int node) const;

  std::vector<std::size_t> starts_;
  Indices neighbors_;
  std::vector<double> weights_;
};

}  // namespace corral
