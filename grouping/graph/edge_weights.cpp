// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_weights.h"

namespace corral {

EdgeWeights::EdgeWeights(const BitGraph& graph) : starts_(static_cast<std::size_t>(graph.size()) + 1) {
  for (int node = 0; node < graph.size(); ++node)
    starts_[static_cast<std::size_t>(node) + 1] = begin(node) + static_cast<std::size_t>(graph.degree(node));
  neighbors_.reserve(starts_.back());
  for (int node = 0; node < graph.size(); ++node)
    graph.for_neighbors(node, [&](int other) { neighbors_.push_back(other); });
  weights_.resize(neighbors_.size());
}

std::vector<double> EdgeWeights::path_sums() const {
  std::vector<double> sums(weights_.size()), row(static_cast<std::size_t>(size()));
  std::vector<std::size_t> back(starts_.begin(), starts_.end() - 1);
  for (int node = 0; node < size(); ++node) {
    for (std::size_t edge = begin(node); edge < end(node); ++edge)
      row[static_cast<std::size_t>(neighbors_[edge])] = weights_[edge];
    for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < end(node); ++edge) {
      const int other = neighbors_[edge];
      sums[edge] = sums[back[static_cast<std::size_t>(other)]++] = weights_[edge] * sum_of_products(other, row);
    }
    for (std::size_t edge = begin(node); edge < end(node); ++edge) row[static_cast<std::size_t>(neighbors_[edge])] = 0;
  }
  return sums;
}

/// Four sums side by side, so that none waits for the last addition.
double EdgeWeights::sum_of_products(int node, const std::vector<double>& factors) const {
  double sums[4] = {0, 0, 0, 0};
  const auto term = [&](std::size_t edge) {
    return factors[static_cast<std::size_t>(neighbors_[edge])] * weights_[edge];
  };
  std::size_t edge = begin(node);
  for (; edge + 4 <= end(node); edge += 4)
    for (std::size_t k = 0; k < 4; ++k) sums[k] += term(edge + k);
  for (; edge < end(node); ++edge) sums[0] += term(edge);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace corral
