// SPDX-License-Identifier: MIT
#include "grouping/compatibility_graph.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "grouping/compatibility.h"
#include "grouping/filter_loops.h"

namespace corral {
namespace {

constexpr int kBits = 8;
constexpr int kTogether = 4;  // blocks whose sums are looked up together

int blocks_of(int columns) { return (columns + kBits - 1) / kBits; }

/// The sums of every subset of four numbers, that of the numbers named by the bits of i at i.
struct alignas(64) SubsetSums {
  double at[16];
};

SubsetSums add_up(const double* numbers, int count) {
  SubsetSums sums{};
  for (int bit = 0; bit < 4; ++bit) {
    const double number = bit < count ? numbers[bit] : 0;
    for (int i = 0; i < 1 << bit; ++i) sums.at[(1 << bit) + i] = sums.at[i] + number;
  }
  return sums;
}

/// For kTogether blocks, and in each for the lower and the upper half of a byte.
using Tables = std::array<std::array<SubsetSums, 2>, kTogether>;

/// to[row] += what the bytes of the row name in the tables.
template <class Lanes>
CORRAL_INLINE void look_up(const Tables& tables, const std::uint8_t* const (&bytes)[kTogether], int rows, double* to) {
  // A table of both halves, which stays in the cache.
  static_assert(kTogether == 4);
  double sums[kTogether][256];
  for (int k = 0; k < kTogether; ++k)
    for (int i = 0; i < 256; ++i)
      sums[k][i] =
          tables[static_cast<std::size_t>(k)][0].at[i % 16] + tables[static_cast<std::size_t>(k)][1].at[i / 16];
  for (int row = 0; row < rows; ++row) {
    double sum = (sums[0][bytes[0][row]] + sums[1][bytes[1][row]]) + (sums[2][bytes[2][row]] + sums[3][bytes[3][row]]);
    asm("" : "+x"(sum));  // compilers that gather or collect the numbers into registers make it slower
    to[row] += sum;
  }
}

/// The same, to the last bit, where a register of indices looks up in two registers of sums.
template <>
CORRAL_INLINE void look_up<lanes::Lanes8>(const Tables& tables, const std::uint8_t* const (&bytes)[kTogether], int rows,
                                          double* to) {
  using Words [[gnu::vector_size(64)]] = std::int64_t;
  using Bytes = std::uint8_t[kLanes];
  lanes::Double8 sums[kTogether][2][2];
  std::memcpy(&sums, &tables, sizeof(sums));
  for (int row = 0; row < rows; row += kLanes) {
    lanes::Double8 of_block[kTogether];
    for (int k = 0; k < kTogether; ++k) {
      Words lower;  // g++ 12 would convert byte by byte
      asm("vpmovzxbq %1, %0" : "=v"(lower) : "m"(*reinterpret_cast<const Bytes*>(bytes[k] + row)));
      const Words upper = lower >> 4;
      of_block[k] = __builtin_shuffle(sums[k][0][0], sums[k][0][1], lower) +
                    __builtin_shuffle(sums[k][1][0], sums[k][1][1], upper);
    }
    const auto before = lanes::Lanes8::load(to + row);
    (before + lanes::Lanes8{(of_block[0] + of_block[1]) + (of_block[2] + of_block[3])}).store(to + row);
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
  AlignedColumn sums(stride_, 0);
  vectorized([&](auto kind) {
    for (int block = 0; block < blocks_of(size_); block += kTogether) {
      Tables tables;
      const std::uint8_t* columns[kTogether];
      for (int k = 0; k < kTogether; ++k) {
        columns[k] = bytes(block + k);
        for (int half = 0; half < 2; ++half) {
          const int first = std::min(kBits * (block + k) + 4 * half, size_);
          tables[static_cast<std::size_t>(k)][static_cast<std::size_t>(half)] =
              add_up(from.data() + first, size_ - first);
        }
      }
      look_up<typename decltype(kind)::Lanes>(tables, columns, size_, sums.data());
    }
  });
  to = Eigen::Map<const Eigen::VectorXd>(sums.data(), size_);
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
    for (std::size_t row = 0; row < rows.size(); ++row)
      to[row] = static_cast<std::uint8_t>(to[row] | (rows[row] >> from & 1) << bit);
  }
  return some;
}

}  // namespace corral
