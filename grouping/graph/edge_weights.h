// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "grouping/graph/bit_graph.h"
#include "kernel/columns.h"

namespace corral {

/// A graph with a number for each edge, the same in both directions.
class EdgeWeights {
 public:
  /// All weights are 0.
  explicit EdgeWeights(const BitGraph& graph);

  /// Bytes for so many nodes and ordered pairs of them that are connected; path_sums() takes 8 for each pair more, and
  /// 8 `matrix_entries`.
  static double memory(int nodes, double pairs) { return 12.0 * pairs + 24.0 * nodes; }
  static double matrix_entries(int nodes) { return nodes <= kMostInMatrix ? (nodes + 4.0) * padded(nodes) : 0; }

  int size() const { return static_cast<int>(starts_.size()) - 1; }

  /// Calls visit(neighbour, weight) for every edge of a node, ascending.
  template <class Visit>
  void for_edges(int node, Visit&& visit) const {
    for (std::size_t edge = begin(node); edge < end(node); ++edge) visit(neighbors_[edge], weights_[edge]);
  }

  /// Sum of weight times factors[neighbour] over the edges of a node.
  double sum_of_products(int node, const std::vector<double>& factors) const;

  /// weight = value(node, neighbour, weight), asked once for each edge, the smaller node first.
  template <class Value>
  void replace_each(Value&& value) {
    std::vector<std::size_t> back(starts_.begin(), starts_.end() - 1);  // the first edge to a node not yet visited
    for (int node = 0; node < size(); ++node)
      for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < end(node); ++edge)
        weights_[edge] = weights_[back[static_cast<std::size_t>(neighbors_[edge])]++] =
            value(node, neighbors_[edge], weights_[edge]);
  }

  /// W_ij sum_k W_ik W_jk over the common neighbours, in the order of the edges; for set(). Sums of eight: those of k = 0, 8,
  /// 16, ..., of k = 1, 9, 17, ... and so on, then of these. Graphs with an edge for one pair in eight or more are
  /// multiplied as whole matrices, with the same sums.
  std::vector<double> path_sums() const;
  void set(std::vector<double> weights) { weights_ = std::move(weights); }

 private:
  static constexpr int kMostInMatrix = 2048;  ///< nodes of graphs that are multiplied as matrices

  void multiply_matrix(std::vector<double>& sums) const;
  std::size_t begin(int node) const { return starts_[static_cast<std::size_t>(node)]; }
  std::size_t end(int node) const { return starts_[static_cast<std::size_t>(node) + 1]; }

  std::vector<std::size_t> starts_;
  Indices neighbors_;
  std::vector<double> weights_;
};

}  // namespace corral
