// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "grouping/graph/bit_graph.h"
#include "kernel/columns.h"

namespace corral {

/// A graph with a number for each edge, the same in both directions.
class EdgeWeights {
 public:
  /// All weights are 0.
  explicit EdgeWeights(const BitGraph& graph);

  /// Bytes for so many nodes and ordered pairs of them that are connected.
  static double memory(int nodes, double pairs) { return 12.0 * pairs + 24.0 * nodes; }

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

  /// Changes the weight at a place that PathSum names.
  void set(std::size_t place, double weight) { weights_[place] = weight; }

 private:
  friend class PathSums;
  std::size_t begin(int node) const { return starts_[static_cast<std::size_t>(node)]; }
  std::size_t end(int node) const { return starts_[static_cast<std::size_t>(node) + 1]; }

  std::vector<std::size_t> starts_;
  Indices neighbors_;
  std::vector<double> weights_;
};

/// V_ij sum_k V_ik V_jk over the common neighbours of the nodes of each edge, V a function of the weights, in the order of the edges.
/// Sums of eight: those of k = 0, 8, 16, ..., of k = 1, 9, 17, ... and so on, then of these. The rows of nodes that are joined to
/// one in eight or more are multiplied as a matrix, with the same sums.
class PathSums {
 public:
  /// `weights` must outlive it; they may change, their graph may not.
  explicit PathSums(const EdgeWeights& weights);

  /// Bytes for so many nodes and ordered pairs of them that are connected.
  static double memory(int nodes, double pairs) {
    const double matrix = nodes <= kMostInMatrix ? 8.0 * (nodes + kStrip) * (padded(nodes) + kStrip) : 0;
    return 8 * pairs + 24.0 * nodes + matrix;
  }

  /// An edge, the smaller node first, and its two places among the weights.
  struct PathSum {
    int node, other;
    std::size_t there, back;
    double sum;
  };
  /// V = value(W). By the smaller node, then by the other. The weights may be set meanwhile.
  void visit(double (*value)(double), const std::function<void(const PathSum&)>& visit);

 private:
  static constexpr int kMostInMatrix = 4096;  ///< nodes of graphs of which rows are multiplied as a matrix
  static constexpr int kStrip = 4;            ///< rows that are multiplied together

  void evaluate(double (*value)(double));
  const double* row_of(int node) const {
    return &rows_[static_cast<std::size_t>(place_[static_cast<std::size_t>(node)]) * columns_];
  }
  double sum_of_products(int node, const double* factors) const;

  const EdgeWeights& weights_;
  // Kept from sum to sum: memory that is new takes longer than the product.
  Indices place_;               ///< of each node among the rows of the matrix, or -1
  std::size_t columns_;         ///< of the matrix
  int row_count_ = 0;           ///< a multiple of kStrip
  std::vector<double> values_;  ///< V of every edge
  AlignedColumn rows_;          ///< the matrix: V of the nodes that are joined to many
};

}  // namespace corral
