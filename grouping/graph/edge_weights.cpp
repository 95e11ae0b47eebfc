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

std::vector<double> EdgeWeights::path_sums() const {
  std::vector<double> sums(weights_.size());
  if (size() <= kMostInMatrix && 8.0 * static_cast<double>(weights_.size()) >= 1.0 * size() * size()) {
    multiply_matrix(sums);
    return sums;
  }
  std::vector<double> row(static_cast<std::size_t>(size()));
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

void EdgeWeights::multiply_matrix(std::vector<double>& sums) const {
  constexpr std::size_t kStrip = 4;
  const auto rows = static_cast<std::size_t>(padded(size()));
  AlignedColumn matrix(rows * rows, 0.0), strip(kStrip * rows);
  for (int node = 0; node < size(); ++node)
    for_edges(node, [&](int other, double weight) {
      matrix[static_cast<std::size_t>(node) * rows + static_cast<std::size_t>(other)] = weight;
    });
  std::vector<std::size_t> back(starts_.begin(), starts_.end() - 1);
  for (std::size_t node = 0; node < static_cast<std::size_t>(size()); ++node) {
    const double* const products = &strip[node % kStrip * rows];
    if (node % kStrip == 0)
      HWY_DYNAMIC_DISPATCH(multiply_strip)(matrix.data(), static_cast<int>(rows), static_cast<int>(node), strip.data());
    for (std::size_t edge = back[node]; edge < starts_[node + 1]; ++edge) {
      const auto other = static_cast<std::size_t>(neighbors_[edge]);
      sums[edge] = sums[back[other]++] = weights_[edge] * products[other];
    }
  }
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

}  // namespace corral
#endif
