// SPDX-License-Identifier: MIT
#include "grouping/graph/compatibility_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"
#include "grouping/graph/subset_sums.h"

namespace corral {
namespace {

constexpr int kBlocksComputed = kBlocksTogether + 1;  // of a product, and what is possible in one of them

int blocks_of(int columns) { return (columns + kBlockColumns - 1) / kBlockColumns; }

int blocks_stored(int size, double most_stored) {
  const double stride = std::max(padded(size, kFloatLanes), 1);
  const auto most = static_cast<int>(std::min<double>(most_stored / stride, padded(blocks_of(size), kBlocksTogether)));
  return most - most % kBlocksTogether;
}

using Numbers = std::vector<std::int32_t, CacheLineAllocator<std::int32_t>>;

}  // namespace

CompatibilityGraph::CompatibilityGraph(const CorrespondenceSet& matches, double similarity, double most_stored)
    : matches_(matches),
      similarity_(similarity),
      most_stored_(most_stored),
      rows_(static_cast<std::size_t>(matches.size())),
      table_(matches) {
  std::iota(rows_.begin(), rows_.end(), 0);
  store();
}

CompatibilityGraph::CompatibilityGraph(const CompatibilityGraph& whole, const Indices& nodes)
    : matches_(whole.matches_),
      similarity_(whole.similarity_),
      most_stored_(whole.most_stored_),
      rows_(nodes.size()),
      table_(whole.table_.subset(nodes)) {
  std::transform(nodes.begin(), nodes.end(), rows_.begin(),
                 [&](int node) { return whole.rows_[static_cast<std::size_t>(node)]; });
  store();
}

void CompatibilityGraph::store() {
  blocks_stored_ = blocks_stored(size(), most_stored_);
  bytes_.assign(static_cast<std::size_t>(blocks_stored_ + kBlocksComputed) * stride(), 0);
  for (int block = 0; block < std::min(blocks_stored_, blocks_of(size())); ++block) compute(block, stored(block));
}

void CompatibilityGraph::compute(int block, std::uint8_t* to) const {
  std::uint8_t* const possible = stored(blocks_stored_ + kBlocksTogether);
  compare_ratios(table_, SimilarityFilter(similarity_), block, to, possible);
  for (int row = 0; row < size(); ++row)
    if (to[row] != possible[row]) decide(row, block, to[row] ^ possible[row], to[row]);
}

void CompatibilityGraph::decide(int row, int block, std::uint8_t undecided, std::uint8_t& certain) const {
  for (int bit = 0; undecided >> bit != 0; ++bit) {
    const int column = kBlockColumns * block + bit;
    if ((undecided >> bit & 1) == 0 || column >= size()) continue;
    const PairDistances distances =
        pair_distances(matches_, rows_[static_cast<std::size_t>(row)], rows_[static_cast<std::size_t>(column)]);
    if (row == column || rigidity_ratio(distances.source, distances.target) >= similarity_)
      certain = static_cast<std::uint8_t>(certain | 1 << bit);
  }
}

double CompatibilityGraph::memory(int rows, double most_stored) {
  const double stride = padded(rows, kFloatLanes);
  return stride * (blocks_stored(rows, most_stored) + kBlocksComputed) + 4.0 * rows + FilterTable::memory(rows);
}

void CompatibilityGraph::multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  Eigen::VectorXd rest = from, rounded, product;
  to = Eigen::VectorXd::Zero(size());
  for (int part = 0; part < 3 && !rest.isZero(0);
       ++part) {  // what is left is negligible beside the rounding of the sum
    rounded = rest;
    round_and_multiply(rounded, product);
    to += product;
    rest -= rounded;
  }
}

void CompatibilityGraph::round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const {
  const double total = numbers.cwiseAbs().sum();
  const double scale = total > 0 ? std::ldexp(1.0, std::clamp(30 - std::ilogb(total), -1000, 1000)) : 1;
  Numbers whole(static_cast<std::size_t>(kBlockColumns * padded(blocks_of(size()), kBlocksTogether)), 0),
      sums(stride(), 0);
  for (int i = 0; i < size(); ++i) whole[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(numbers(i) * scale);
  numbers = Eigen::Map<const Eigen::Matrix<std::int32_t, -1, 1>>(whole.data(), size()).cast<double>() / scale;
  const auto step = static_cast<std::ptrdiff_t>(stride());
  add_named({bytes_.data(), size(), step, blocks_stored_}, whole.data(), sums.data());
  computed_ = -1;
  for (int first = blocks_stored_; first < blocks_of(size()); first += kBlocksTogether) {
    const int count = std::min(kBlocksTogether, blocks_of(size()) - first);
    for (int k = 0; k < count; ++k) compute(first + k, stored(blocks_stored_ + k));
    add_named({stored(blocks_stored_), size(), step, count}, whole.data() + kBlockColumns * first, sums.data());
  }
  to = Eigen::Map<const Eigen::Matrix<std::int32_t, -1, 1>>(sums.data(), size()).cast<double>() / scale;
}

Eigen::VectorXd CompatibilityGraph::degrees() const {
  Eigen::VectorXd sums;
  multiply(Eigen::VectorXd::Ones(size()), sums);
  return sums;
}

void CompatibilityGraph::get_column(int node, Eigen::VectorXd& column) const {
  const int block = node / kBlockColumns;
  const bool is_stored = block < blocks_stored_;
  if (!is_stored && std::exchange(computed_, block) != block) compute(block, stored(blocks_stored_));
  const std::uint8_t* const from = stored(is_stored ? block : blocks_stored_);
  column.resize(size());
  for (int row = 0; row < size(); ++row) column(row) = from[row] >> node % kBlockColumns & 1;
}

std::unique_ptr<GraphMatrix> CompatibilityGraph::restricted(const Indices& nodes) const {
  return std::unique_ptr<GraphMatrix>(new CompatibilityGraph(*this, nodes));
}

}  // namespace corral
