// SPDX-License-Identifier: MIT
#include "grouping/compatibility_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "grouping/compatibility.h"
#include "grouping/filter_loops.h"

namespace corral {
namespace {

constexpr int kBits = 8;
constexpr int kTogether = 4;  // blocks whose sums are looked up together

int blocks_of(int columns) { return (columns + kBits - 1) / kBits; }

using Number = std::int32_t;
using Numbers = std::vector<Number, CacheLineAllocator<Number>>;

/// The sums of every subset of four numbers, that of the numbers named by the bits of i at i.
struct alignas(64) SubsetSums {
  Number at[16];
};

SubsetSums add_up(const Number* numbers) {
  SubsetSums sums{};
  for (int bit = 0; bit < 4; ++bit)
    for (int i = 0; i < 1 << bit; ++i) sums.at[(1 << bit) + i] = sums.at[i] + numbers[bit];
  return sums;
}

/// For kTogether blocks, and in each for the lower and the upper half of a byte.
using Tables = std::array<std::array<SubsetSums, 2>, kTogether>;

/// to[row] += what the bytes of the row name in the tables.
template <class Floats>
CORRAL_INLINE void look_up(const Tables& tables, const std::uint8_t* const (&bytes)[kTogether], int rows, Number* to) {
  // A table of both halves, which stays in the cache.
  static_assert(kTogether == 4);
  Number sums[kTogether][256];
  for (int k = 0; k < kTogether; ++k)
    for (int i = 0; i < 256; ++i)
      sums[k][i] =
          tables[static_cast<std::size_t>(k)][0].at[i % 16] + tables[static_cast<std::size_t>(k)][1].at[i / 16];
  for (int row = 0; row < rows; ++row)
    to[row] += sums[0][bytes[0][row]] + sums[1][bytes[1][row]] + sums[2][bytes[2][row]] + sums[3][bytes[3][row]];
}

/// The same where a register of indices looks up in a register of sums.
template <>
CORRAL_INLINE void look_up<lanes::Floats16>(const Tables& tables, const std::uint8_t* const (&bytes)[kTogether],
                                            int rows, Number* to) {
  using Words = lanes::Integers16;
  using Bytes = std::uint8_t[kFloatLanes];
  Words sums[kTogether][2];
  std::memcpy(&sums, &tables, sizeof(sums));
  for (int row = 0; row < rows; row += kFloatLanes) {
    Words sum;
    std::memcpy(&sum, to + row, sizeof(sum));
    for (int k = 0; k < kTogether; ++k) {
      Words lower;  // g++ 12 would convert byte by byte
      asm("vpmovzxbd %1, %0" : "=v"(lower) : "m"(*reinterpret_cast<const Bytes*>(bytes[k] + row)));
      sum += __builtin_shuffle(sums[k][0], lower) + __builtin_shuffle(sums[k][1], lower >> 4);
    }
    std::memcpy(to + row, &sum, sizeof(sum));
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

double CompatibilityGraph::memory(int rows) {
  return static_cast<double>(padded(rows, kFloatLanes)) * (padded(blocks_of(rows), kTogether) + 1);
}

void CompatibilityGraph::multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  Eigen::VectorXd rest = from, rounded, product;
  to = Eigen::VectorXd::Zero(size_);
  for (int part = 0; part < 3; ++part) {  // what remains then is nothing beside the rounding of the sum
    rounded = rest;
    round_and_multiply(rounded, product);
    to += product;
    rest -= rounded;
  }
}

void CompatibilityGraph::round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const {
  const double total = numbers.cwiseAbs().sum();
  const double scale = total > 0 ? std::ldexp(1.0, std::clamp(30 - std::ilogb(total), -1000, 1000)) : 1;
  Numbers whole(static_cast<std::size_t>(kBits * padded(blocks_of(size_), kTogether)), 0), sums(stride_, 0);
  for (int i = 0; i < size_; ++i) whole[static_cast<std::size_t>(i)] = static_cast<Number>(numbers(i) * scale);
  numbers = Eigen::Map<const Eigen::Matrix<Number, -1, 1>>(whole.data(), size_).cast<double>() / scale;
  vectorized([&](auto kind) {
    for (int block = 0; block < blocks_of(size_); block += kTogether) {
      Tables tables;
      const std::uint8_t* columns[kTogether];
      for (int k = 0; k < kTogether; ++k) {
        columns[k] = bytes(block + k);
        for (int half = 0; half < 2; ++half)
          tables[static_cast<std::size_t>(k)][static_cast<std::size_t>(half)] =
              add_up(whole.data() + kBits * (block + k) + 4 * half);
      }
      look_up<typename decltype(kind)::Floats>(tables, columns, size_, sums.data());
    }
  });
  to = Eigen::Map<const Eigen::Matrix<Number, -1, 1>>(sums.data(), size_).cast<double>() / scale;
}

Eigen::VectorXd CompatibilityGraph::degrees() const {
  Eigen::VectorXd sums;
  multiply(Eigen::VectorXd::Ones(size_), sums);
  return sums;
}

void CompatibilityGraph::get_column(int node, Eigen::VectorXd& column) const {
  const std::uint8_t* const from = bytes(node / kBits);
  column.resize(size_);
  for (int row = 0; row < size_; ++row) column(row) = from[row] >> node % kBits & 1;
}

std::unique_ptr<GraphMatrix> CompatibilityGraph::restricted(const Indices& nodes) const {
  std::unique_ptr<CompatibilityGraph> some(new CompatibilityGraph(static_cast<int>(nodes.size())));
  std::vector<std::uint8_t> rows(some->stride_);  // the chosen rows of a block
  int copied = -1;
  for (int column = 0; column < some->size_; ++column) {
    const int node = nodes[static_cast<std::size_t>(column)], block = node / kBits, from = node % kBits,
              bit = column % kBits;
    if (block != std::exchange(copied, block))
      std::transform(nodes.begin(), nodes.end(), rows.begin(), [of = bytes(block)](int row) { return of[row]; });
    std::uint8_t* const to = some->bytes(column / kBits);
    const auto mask = static_cast<std::uint8_t>(1 << from), set = static_cast<std::uint8_t>(1 << bit);
    for (std::size_t row = 0; row < rows.size(); ++row)
      to[row] = static_cast<std::uint8_t>(to[row] | ((rows[row] & mask) == mask ? set : 0));
  }
  return some;
}

}  // namespace corral
