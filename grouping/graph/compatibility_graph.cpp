// SPDX-License-Identifier: MIT
#include "grouping/graph/compatibility_graph.h"

#include <algorithm>
#include <array>
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

/// What each byte becomes when its bits move: bit k to places[k], or nowhere.
std::array<std::uint8_t, 256> moved_bits(const std::array<int, kBlockColumns>& places) {
  std::array<std::uint8_t, 256> bytes{};
  for (std::size_t byte = 0; byte < bytes.size(); ++byte)
    for (std::size_t bit = 0; bit < places.size(); ++bit)
      if (places[bit] >= 0 && (byte >> bit & 1) != 0)
        bytes[byte] = static_cast<std::uint8_t>(bytes[byte] | 1 << places[bit]);
  return bytes;
}

/// Gathers a block out of others: its columns are nodes[first] .. of them, its rows `nodes`.
void gather(const std::uint8_t* blocks, std::size_t stride, const Indices& nodes, std::size_t first, std::uint8_t* to) {
  const std::size_t end = std::min(first + kBlockColumns, nodes.size());
  for (std::size_t column = first; column < end;) {
    const int block = nodes[column] / kBlockColumns;
    std::array<int, kBlockColumns> places;
    places.fill(-1);
    for (; column < end && nodes[column] / kBlockColumns == block; ++column)
      places[static_cast<std::size_t>(nodes[column] % kBlockColumns)] = static_cast<int>(column - first);
    const auto bytes = moved_bits(places);
    const std::uint8_t* const from = blocks + static_cast<std::size_t>(block) * stride;
    for (std::size_t row = 0; row < nodes.size(); ++row)
      to[row] = static_cast<std::uint8_t>(to[row] | bytes[from[nodes[row]]]);
  }
}

}  // namespace

CompatibilityGraph::CompatibilityGraph(const CorrespondenceSet& matches, double similarity, double most_stored)
    : matches_(matches),
      similarity_(similarity),
      most_stored_(most_stored),
      rows_(static_cast<std::size_t>(matches.size())),
      table_(matches),
      blocks_stored_(blocks_stored(size(), most_stored)),
      bytes_(static_cast<std::size_t>(blocks_stored_ + kBlocksComputed) * stride(), 0) {
  std::iota(rows_.begin(), rows_.end(), 0);
  compute_from(0);
}

CompatibilityGraph::CompatibilityGraph(const CompatibilityGraph& whole, const Indices& nodes)
    : matches_(whole.matches_),
      similarity_(whole.similarity_),
      most_stored_(whole.most_stored_),
      rows_(nodes.size()),
      table_(whole.table_.subset(nodes)),
      blocks_stored_(blocks_stored(size(), most_stored_)),
      bytes_(static_cast<std::size_t>(blocks_stored_ + kBlocksComputed) * stride(), 0) {
  take_rows(whole.rows_, nodes);
  compute_from(take_blocks(whole.bytes_.data(), whole.stride(), whole.blocks_stored_, nodes));
}

void CompatibilityGraph::keep(const Indices& nodes) {
  const std::size_t old_stride = stride();
  const int old_blocks = blocks_stored_;
  table_ = table_.subset(nodes);
  take_rows(Indices(rows_), nodes);
  const double room = static_cast<double>(bytes_.size()) - kBlocksComputed * static_cast<double>(stride());
  blocks_stored_ = blocks_stored(size(), std::min(room, most_stored_));
  const int taken = take_blocks(bytes_.data(), old_stride, old_blocks, nodes);
  bytes_.resize(static_cast<std::size_t>(blocks_stored_ + kBlocksComputed) * stride());
  computed_ = -1;
  compute_from(taken);
}

void CompatibilityGraph::take_rows(const Indices& rows, const Indices& nodes) {
  rows_.resize(nodes.size());
  std::transform(nodes.begin(), nodes.end(), rows_.begin(),
                 [&](int node) { return rows[static_cast<std::size_t>(node)]; });
}

/// The columns that were stored become the first blocks. A block is never written before what lies there was read, as its
/// columns lay no farther to the front and no row was shorter.
int CompatibilityGraph::take_blocks(const std::uint8_t* blocks, std::size_t stride, int count, const Indices& nodes) {
  const auto columns = std::lower_bound(nodes.begin(), nodes.end(), count * kBlockColumns) - nodes.begin();
  const bool all = columns == size();
  const int taken = std::min(static_cast<int>(all ? blocks_of(size()) : columns / kBlockColumns), blocks_stored_);
  std::vector<std::uint8_t> block(this->stride());
  for (int i = 0; i < taken; ++i) {
    std::fill(block.begin(), block.end(), 0);
    gather(blocks, stride, nodes, static_cast<std::size_t>(kBlockColumns * i), block.data());
    std::copy(block.begin(), block.end(), stored(i));
  }
  return taken;
}

void CompatibilityGraph::compute_from(int block) {
  for (; block < std::min(blocks_stored_, blocks_of(size())); ++block) compute(block, stored(block));
}

void CompatibilityGraph::compute(int block, std::uint8_t* to) const {
  std::uint8_t* const possible = stored(blocks_stored_ + kBlocksTogether);
  compare_ratios(table_, SimilarityFilter(similarity_), block, to, possible);
  for (int first = 0; first < size(); first += kFloatLanes) {
    if (std::equal(to + first, to + first + kFloatLanes, possible + first)) continue;
    for (int row = first; row < std::min(first + kFloatLanes, size()); ++row)
      if (to[row] != possible[row]) decide(row, block, to[row] ^ possible[row], to[row]);
  }
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
  for (int first = blocks_stored_; first < blocks_of(size()); first += kBlocksTogether) {
    const int count = std::min(kBlocksTogether, blocks_of(size()) - first);
    const auto number = whole.begin() + kBlockColumns * first;
    if (std::all_of(number, number + kBlockColumns * count, [](std::int32_t each) { return each == 0; })) continue;
    computed_ = -1;
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
