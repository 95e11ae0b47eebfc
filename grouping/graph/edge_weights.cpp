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

/// The scalar products of four rows with four others.
HWY_INLINE void multiply_tile(const double* a, const double* b, std::size_t columns, double (&products)[kTile][kTile]) {
  Lanes sums[kTile][kTile];
  for (auto& row : sums)
    for (Lanes& entry : row) entry = Lanes::fill(0);
  for (std::size_t k = 0; k < columns; k += kLanes) {
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

/// Four rows of a matrix, from `first` on, times these and all that follow: strip[i * rows + j].
HWY_FLATTEN void multiply_strip(const double* matrix, int rows, std::size_t columns, int first, double* strip) {
  for (int j = first; j < rows; j += kTile) {
    double tile[kTile][kTile];
    multiply_tile(matrix + first * columns, matrix + j * columns, columns, tile);
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

namespace {

/// Of weights[edge] times factors[neighbors[edge]], in the order of lanes.
double sum_of(const int* neighbors, const double* weights, std::size_t edges, const double* factors) {
  double s[kLanes] = {};
  for (std::size_t edge = 0; edge < edges; ++edge) {
    const auto other = static_cast<std::size_t>(neighbors[edge]);
    s[other % kLanes] += factors[other] * weights[edge];
  }
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

}  // namespace

double EdgeWeights::sum_of_products(int node, const std::vector<double>& factors) const {
  const std::size_t first = begin(node);
  return sum_of(neighbors_.data() + first, weights_.data() + first, end(node) - first, factors.data());
}

PathSums::PathSums(const EdgeWeights& weights)
    : weights_(weights),
      place_(static_cast<std::size_t>(weights.size()), -1),
      columns_(static_cast<std::size_t>(padded(weights.size()))),
      values_(weights.neighbors_.size()) {
  if (weights.size() > kMostInMatrix) return;
  for (int node = 0; node < weights.size(); ++node)
    if (8 * (weights.end(node) - weights.begin(node)) >= static_cast<std::size_t>(weights.size()))
      place_[static_cast<std::size_t>(node)] = row_count_++;
  row_count_ = (row_count_ + kStrip - 1) / kStrip * kStrip;
  rows_.assign(static_cast<std::size_t>(row_count_) * columns_, 0.0);
}

double PathSums::sum_of_products(int node, const double* factors) const {
  const std::size_t first = weights_.begin(node);
  return sum_of(weights_.neighbors_.data() + first, values_.data() + first, weights_.end(node) - first, factors);
}

void PathSums::evaluate(double (*value)(double)) {
  std::vector<std::size_t> back(weights_.starts_.begin(), weights_.starts_.end() - 1);
  for (int node = 0; node < weights_.size(); ++node)
    for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < weights_.end(node); ++edge)
      values_[edge] = values_[back[static_cast<std::size_t>(weights_.neighbors_[edge])]++] =
          value(weights_.weights_[edge]);
  for (int node = 0; node < weights_.size(); ++node) {
    const int place = place_[static_cast<std::size_t>(node)];
    if (place < 0) continue;
    double* const row = &rows_[static_cast<std::size_t>(place) * columns_];
    for (std::size_t edge = weights_.begin(node); edge < weights_.end(node); ++edge)
      row[static_cast<std::size_t>(weights_.neighbors_[edge])] = values_[edge];
  }
}

void PathSums::visit(double (*value)(double), const std::function<void(const PathSum&)>& visit) {
  evaluate(value);
  AlignedColumn strip(static_cast<std::size_t>(kStrip * row_count_));
  std::vector<double> scattered(columns_);
  std::vector<std::size_t> back(weights_.starts_.begin(), weights_.starts_.end() - 1);
  for (int node = 0; node < weights_.size(); ++node) {
    const int place = place_[static_cast<std::size_t>(node)];
    const std::size_t first = weights_.begin(node), last = weights_.end(node);
    if (place >= 0 && place % kStrip == 0)
      HWY_DYNAMIC_DISPATCH(multiply_strip)(rows_.data(), row_count_, columns_, place, strip.data());
    const double* const products = strip.data() + std::max(0, place) % kStrip * row_count_;
    const double* const row = place >= 0 ? row_of(node) : scattered.data();
    for (std::size_t edge = first; place < 0 && edge < last; ++edge)
      scattered[static_cast<std::size_t>(weights_.neighbors_[edge])] = values_[edge];
    for (std::size_t edge = back[static_cast<std::size_t>(node)]; edge < last; ++edge) {
      const int other = weights_.neighbors_[edge], column = place_[static_cast<std::size_t>(other)];
      double sum;
      if (place >= 0 && column >= 0)
        sum = products[column];
      else
        sum = column >= 0 ? sum_of_products(node, row_of(other)) : sum_of_products(other, row);
      visit({node, other, edge, back[static_cast<std::size_t>(other)]++, values_[edge] * sum});
    }
    for (std::size_t edge = first; place < 0 && edge < last; ++edge)
      scattered[static_cast<std::size_t>(weights_.neighbors_[edge])] = 0;
  }
}

}  // namespace corral
#endif
