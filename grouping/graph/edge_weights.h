// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "grouping/graph/bit_graph.h"

namespace corral {

/// A graph with a number for each edge, the same in both directions.
class EdgeWeights {
 public:
  /// All weights are 0.
  explicit EdgeWeights(const BitGraph& graph);

  /// Bytes for so many nodes, all of them connected; path_sums() takes 8 for each pair more.
  static double memory(int nodes) { return 12.0 * nodes * nodes + 24.0 * nodes; }

  int size() const { return static_cast<int>(starts_.size()) - 1; }

  /// Calls visit(neighbour, weight) for every edge of a node, ascending.
  template <class Visit>
  void for_edges(int node, Visit&& visit) const {
    for (std::size_t edge = begin(node); edge < end(node); ++edge) visit(neighbors_[edge], weights_[edge]);
  }

  /// Sum of weight times factors[neighbour] over the edges of a node.
  double sum_of_products(int node, const std::vector<double>& factors) const;

  /// weight = value(node, neighbour, weight), which must be symmetric in the nodes.
  template <class Value>
  void replace_each(Value&& value) {
    for (int node = 0; node < size(); ++node)
      for (std::size_t edge = begin(node); edge < end(node); ++edge)
        weights_[edge] = value(node, neighbors_[edge], weights_[edge]);
  }

  /// W_ij sum_k W_ik W_jk over the common neighbours, in the order of the edges; for set().
  std::vector<double> path_sums() const;
  void set(std::vector<double> weights) { weights_ = std::move(weights); }

 private:
  std::size_t begin(int node) const { return starts_[static_cast<std::size_t>(node)]; }
  std::size_t end(int node) const { return starts_[static_cast<std::size_t>(node) + 1]; }

  std::vector<std::size_t> starts_;
  Indices neighbors_;
  std::vector<double> weights_;
};

}  // namespace corral
