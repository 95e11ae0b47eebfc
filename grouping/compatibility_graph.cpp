// SPDX-License-Identifier: MIT
#include "grouping/compatibility_graph.h"

#include <algorithm>
#include <array>

#include "grouping/compatibility.h"
#include "grouping/filter_loops.h"

namespace corral {
namespace {

constexpr int kBits = 8;
constexpr int kTogether = 4;  // blocks whose sums are looked up together

int blocks_of(int columns) { return (columns + kBits - 1) / kBits; }

/// The sums of every subset of eight numbers, that of the numbers named by the bits of i at i.
using SubsetSums = std::array<double, 256>;

void add_up(const double* numbers, int count, SubsetSums& sums) {
  sums[0] = 0;
  for (int bit = 0; bit < kBits; ++bit) {
    const double number = bit < count ? numbers[bit] : 0;
    const std::size_t half = std::size_t{1} << bit;
    for (std::size_t i = 0; i < half; ++i) sums[half + i] = sums[i] + number;
  }
}

}  // namespace

CompatibilityGraph::CompatibilityGraph(int size)
    : size_(size),
      stride_(static_cast<std::size_t>(padded(size, kFloatLanes))),
      bytes_(stride_ * static_cast<std::size_t>(padded(blocks_of(size), kTogether)), 0) {}

CompatibilityGraph::CompatibilityGraph(const CorrespondenceSet& matches, double similarity)
    : CompatibilityGraph(matches.size()) {
  const FilterTable table(matches);
  const SimilarityFilter filter(similarity);
  std::vector<std::uint8_t> possible(stride_);
  for (int block = 0; block < blocks_of(size_); ++block) {
    std::uint8_t* const certain = bytes(block);
    compare_ratios(table, filter, block, certain, possible.data());
    for (int row = 0; row < size_; ++row) {
      std::uint8_t undecided = certain[row] ^ possible[static_cast<std::size_t>(row)];
      for (int bit = 0; undecided >> bit != 0; ++bit) {
        const int column = kBits * block + bit;
        if ((undecided >> bit & 1) == 0 || column >= size_) continue;
        const PairDistances distances = pair_distances(matches, row, column);
        if (row == column || rigidity_ratio(distances.source, distances.target) >= similarity)
          certain[row] = static_cast<std::uint8_t>(certain[row] | 1 << bit);
      }
    }
  }
}

void CompatibilityGraph::multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  to.setZero(size_);
  std::array<SubsetSums, kTogether> sums;
  for (int block = 0; block < blocks_of(size_); block += kTogether) {
    for (int k = 0; k < kTogether; ++k) {
      const int first = kBits * (block + k);
      add_up(from.data() + std::min(first, size_), std::clamp(size_ - first, 0, kBits),
             sums[static_cast<std::size_t>(k)]);
    }
    const std::uint8_t *a = bytes(block), *b = bytes(block + 1), *c = bytes(block + 2), *d = bytes(block + 3);
    for (int row = 0; row < size_; ++row)
      to(row) += (sums[0][a[row]] + sums[1][b[row]]) + (sums[2][c[row]] + sums[3][d[row]]);
  }
}

void CompatibilityGraph::get_column(int node, Eigen::VectorXd& column) const {
  const std::uint8_t* const from = bytes(node / kBits);
  column.resize(size_);
  for (int row = 0; row < size_; ++row) column(row) = from[row] >> node % kBits & 1;
}

std::unique_ptr<GraphMatrix> CompatibilityGraph::restricted(const Indices& nodes) const {
  std::unique_ptr<CompatibilityGraph> some(new CompatibilityGraph(static_cast<int>(nodes.size())));
  for (int column = 0; column < some->size_; ++column) {
    const int node = nodes[static_cast<std::size_t>(column)];
    const std::uint8_t* const from = bytes(node / kBits);
    std::uint8_t* const to = some->bytes(column / kBits);
    for (int row = 0; row < some->size_; ++row)
      to[row] = static_cast<std::uint8_t>(to[row] | (from[nodes[static_cast<std::size_t>(row)]] >> node % kBits & 1)
                                                        << column % kBits);
  }
  return some;
}

}  // namespace corral
