// SPDX-License-Identifier: MIT
#include "grouping/compatibility_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "grouping/compatibility.h"
#include "grouping/filter_loops.h"
#include "grouping/subset_sums.h"

namespace corral {
namespace {

int blocks_of(int columns) { return (columns + kBlockColumns - 1) / kBlockColumns; }

using Numbers = std::vector<std::int32_t, CacheLineAllocator<std::int32_t>>;

}  // namespace

CompatibilityGraph::CompatibilityGraph(int size)
    : size_(size),
      stride_(static_cast<std::size_t>(padded(size, kFloatLanes))),
      bytes_(stride_ * static_cast<std::size_t>(padded(blocks_of(size), kBlocksTogether)), 0) {}

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
        const int column = kBlockColumns * block + bit;
        if ((undecided >> bit & 1) == 0 || column >= size_) continue;
        const PairDistances distances = pair_distances(matches, row, column);
        if (row == column || rigidity_ratio(distances.source, distances.target) >= similarity)
          certain[row] = static_cast<std::uint8_t>(certain[row] | 1 << bit);
      }
    }
  }
}

double CompatibilityGraph::memory(int rows) {
  return static_cast<double>(padded(rows, kFloatLanes)) * (padded(blocks_of(rows), kBlocksTogether) + 1);
}

void CompatibilityGraph::multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  Eigen::VectorXd rest = from, rounded, product;
  to = Eigen::VectorXd::Zero(size_);
  for (int part = 0; part < 3; ++part) {  // the rest is negligible beside the rounding of the sum
    rounded = rest;
    round_and_multiply(rounded, product);
    to += product;
    rest -= rounded;
  }
}

void CompatibilityGraph::round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const {
  const double total = numbers.cwiseAbs().sum();
  const double scale = total > 0 ? std::ldexp(1.0, std::clamp(30 - std::ilogb(total), -1000, 1000)) : 1;
  Numbers whole(static_cast<std::size_t>(kBlockColumns * padded(blocks_of(size_), kBlocksTogether)), 0),
      sums(stride_, 0);
  for (int i = 0; i < size_; ++i) whole[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(numbers(i) * scale);
  numbers = Eigen::Map<const Eigen::Matrix<std::int32_t, -1, 1>>(whole.data(), size_).cast<double>() / scale;
  add_named({bytes_.data(), size_, static_cast<std::ptrdiff_t>(stride_), blocks_of(size_)}, whole.data(), sums.data());
  to = Eigen::Map<const Eigen::Matrix<std::int32_t, -1, 1>>(sums.data(), size_).cast<double>() / scale;
}

Eigen::VectorXd CompatibilityGraph::degrees() const {
  Eigen::VectorXd sums;
  multiply(Eigen::VectorXd::Ones(size_), sums);
  return sums;
}

void CompatibilityGraph::get_column(int node, Eigen::VectorXd& column) const {
  const std::uint8_t* const from = bytes(node / kBlockColumns);
  column.resize(size_);
  for (int row = 0; row < size_; ++row) column(row) = from[row] >> node % kBlockColumns & 1;
}

std::unique_ptr<GraphMatrix> CompatibilityGraph::restricted(const Indices& nodes) const {
  std::unique_ptr<CompatibilityGraph> some(new CompatibilityGraph(static_cast<int>(nodes.size())));
  std::vector<std::uint8_t> rows(some->stride_);  // the chosen rows of a block
  int copied = -1;
  for (int column = 0; column < some->size_; ++column) {
    const int node = nodes[static_cast<std::size_t>(column)], block = node / kBlockColumns, from = node % kBlockColumns,
              bit = column % kBlockColumns;
    if (block != std::exchange(copied, block))
      std::transform(nodes.begin(), nodes.end(), rows.begin(), [of = bytes(block)](int row) { return of[row]; });
    std::uint8_t* const to = some->bytes(column / kBlockColumns);
    const auto mask = static_cast<std::uint8_t>(1 << from), set = static_cast<std::uint8_t>(1 << bit);
    for (std::size_t row = 0; row < rows.size(); ++row)
      to[row] = static_cast<std::uint8_t>(to[row] | ((rows[row] & mask) == mask ? set : 0));
  }
  return some;
}

}  // namespace corral
