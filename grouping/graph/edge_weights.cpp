// SPDX-License-Identifier: MIT
#include "grouping/graph/edge_weights.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/edge_weights.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

constexpr int kTile = 4;

/// The scalar products of four rows with four others, each of `padded` columns.
HWY_INLINE void multiply_tile(const double* a, const double* b, int columns, double (&products)[kTile][kTile]) {
  Lanes sums[kTile][kTile];
  for (auto& row : sums)
    for (Lanes& entry : row) entry = Lanes::fill(0);
  for (int k = 0; k < columns; k += kLanes) {
    Lanes right[kTile];
    for (int j = 0; j < kTile; ++j) right[j] = Lanes::load(b + j * columns + k);
    for (int i = 0; i < kTile; ++i) {
      const Lanes left = Lanes::load(a + i * columns + k);
      for (int j = 0; j < kTile; ++j) sums[i][j] = sums[i][j] + left * right[j];
    }
  }
  for (int i = 0; i < kTile; ++i)
    for (int j = 0; j < kTile; ++j) products[i][j] = sum(sums[i][j]);
}

/// Four rows, from `first` on, of matrix matrix, from that column on and where the matrix is not 0; matrix is symmetric, of `rows`
/// (a multiple of eight) rows.
HWY_FLATTEN void multiply_strip(const double* matrix, int rows, int first, double* strip) {
  const double* const left = matrix + static_cast<std::ptrdiff_t>(first) * rows;
  for (int j = first; j < rows; j += kTile) {
    bool is_empty = true;
    for (int k = 0; k < kTile * kTile; ++k) is_empty &= left[k / kTile * rows + j + k % kTile] == 0;
    if (is_empty) continue;
    double tile[kTile][kTile];
    multiply_tile(left, matrix + static_cast<std::ptrdiff_t>(j) * rows, rows, tile);
    for (int k = 0; k < kTile * kTile; ++k) strip[k / kTile * rows + j + k % kTile] = tile[k / kTile][k % kTile];
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(multiply_strip);

EdgeWeights::EdgeWeights(const BitGraph& graph) : starts_(static_cast<std::size_t>(graph.size()) + 1) {
  for (int node = 0; node < graph.size(); ++node)
    starts_[static_cast<std::size_t>(node) + 1] = begin(node) + static_cast<std::size_t>(graph.degree(node));
  neighbors_.reserve(starts_.back());
  for (int node = 0; node < graph.size(); ++node)
    graph.for_neighbors(node, [&](int other) { neighbors_.push_back(other); });
  weights_.resize(neighbors_.size());
}

/// In the order of lanes.
double EdgeWeights::sum_of_products(int node, const std::vector<double>& factors) const {
  double s[kLanes] = {};
  for (std::size_t edge = begin(node); edge < end(node); ++edge) {
    const auto other = static_cast<std::size_t>(neighbors_[edge]);
    s[other % kLanes] += factors[other] * weights_[edge];
  }
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

PathSums::PathSums(const EdgeWeights& weights) : weights_(weights) {
  const auto rows = static_cast<std::size_t>(padded(weights.size()));
  const double edges = static_cast<double>(weights.neighbors_.size());
  if (weights.size() <= kMostInMatrix && 8 * edges >= 1.0 * weights.size() * weights.size())
    matrix_.assign(rows * rows, 0.0);
}

void PathSums::visit(double (*value)(double), const std::function<void(const PathSum&)>& visit) {
  if (!matrix_.empty()) return multiply_matrix(value, visit);
  EdgeWeights values = weights_;
  values.replace_each([&](int, int, double weight) { return value(weight); });
  std::vector<double> row(static_cast<std::size_t>(values.size()));
  std::vector<std::size_t> back(values.starts_.begin(), values.starts_.end() - 1);
  for (int node = 0; node < values.size(); ++node) {
    values.for_edges(node, [&](int other, double each) { row[static_cast<std::size_t>(other)] = each; });
    for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < values.end(node); ++edge) {
      const int other = values.neighbors_[edge];
      visit({node, other, edge, back[static_cast<std::size_t>(other)]++,
             values.weights_[edge] * values.sum_of_products(other, row)});
    }
    values.for_edges(node, [&](int other, double) { row[static_cast<std::size_t>(other)] = 0; });
  }
}

void PathSums::multiply_matrix(double (*value)(double), const std::function<void(const PathSum&)>& visit) {
  const auto rows = static_cast<std::size_t>(padded(weights_.size()));
  const auto at = [&](int row, int column) -> double& {
    return matrix_[static_cast<std::size_t>(row) * rows + static_cast<std::size_t>(column)];
  };
  AlignedColumn strip(kStrip * rows);
  for (int node = 0; node < weights_.size(); ++node)
    weights_.for_edges(node, [&](int other, double weight) {
      if (other > node) at(node, other) = at(other, node) = value(weight);
    });
  std::vector<std::size_t> back(weights_.starts_.begin(), weights_.starts_.end() - 1);
  for (int node = 0; node < weights_.size(); ++node) {
    const double* const products = &strip[static_cast<std::size_t>(node) % kStrip * rows];
    if (static_cast<std::size_t>(node) % kStrip == 0)
      HWY_DYNAMIC_DISPATCH(multiply_strip)(matrix_.data(), static_cast<int>(rows), node, strip.data());
    for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < weights_.end(node); ++edge) {
      const int other = weights_.neighbors_[edge];
      visit({node, other, edge, back[static_cast<std::size_t>(other)]++,
             at(node, other) * products[static_cast<std::size_t>(other)]});
    }
  }
}

}  // namespace corral
#endif
