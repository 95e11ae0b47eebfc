// SPDX-License-Identifier: MIT
#include "grouping/graph/bit_graph.h"

#include <hwy/base.h>

#include <algorithm>
#include <cmath>

#include "grouping/columns/compatibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/bit_graph.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

/// The bits that two nodes have in common, counted by bytes for as long as these hold the sum.
HWY_INLINE std::uint64_t count_shared(const std::uint64_t* a, const std::uint64_t* b, std::size_t words) {
  std::uint64_t count = 0;
  std::size_t word = 0;
#if HWY_TARGET != HWY_SCALAR
  constexpr std::size_t kMost = 31;  // vectors whose bits a byte can count
  const hn::ScalableTag<std::uint64_t> tag;
  const hn::Repartition<std::uint8_t, decltype(tag)> bytes;
  const std::size_t lanes = hn::Lanes(tag);
  auto sums = hn::Zero(tag);
  while (word + lanes <= words) {
    auto few = hn::Zero(bytes);
    for (std::size_t k = 0; k < kMost && word + lanes <= words; ++k, word += lanes) {
      const auto shared = hn::And(hn::LoadU(tag, a + word), hn::LoadU(tag, b + word));
      few = hn::Add(few, hn::PopulationCount(hn::BitCast(bytes, shared)));
    }
    sums = hn::Add(sums, hn::SumsOf8(few));
  }
  count = hn::GetLane(hn::SumOfLanes(tag, sums));
#endif
  for (; word < words; ++word) count += hwy::PopCount(a[word] & b[word]);
  return count;
}

HWY_FLATTEN int count_bits_in_both(const std::uint64_t* a, const std::uint64_t* b, int words) {
  return static_cast<int>(count_shared(a, b, static_cast<std::size_t>(words)));
}

HWY_FLATTEN void count_common(const BitGraph& graph, int node, const Indices& others, int* counts) {
  for (std::size_t k = 0; k < others.size(); ++k)
    counts[k] = static_cast<int>(
        count_shared(graph.neighbors(node), graph.neighbors(others[k]), static_cast<std::size_t>(graph.words())));
}

/// Adds the common neighbours in a strip for each edge of a block that may still have `least`.
HWY_FLATTEN void add_common(const BitGraph& graph, const BitGraph::BlockEdges& edges, const BitGraph::Strip& strip,
                            int least, int* counts) {
  edges.for_each([&](int i, int j) {
    int& count = *counts++;
    const auto node = static_cast<std::size_t>(i - edges.first());
    if (strip.degrees[node] == 0 || count + strip.rest[node] < least) return;
    const auto words = static_cast<std::size_t>(strip.words);
    count += static_cast<int>(count_shared(&strip.rows[node * words], graph.neighbors(j) + strip.word, words));
  });
}

/// Lengths from one row, in the two clouds.
struct Lengths {
  const CorrespondenceSet& matches;
  int row;

  HWY_INLINE Lanes from(const Points& points, int j) const {
    const Lanes x = Lanes::fill(points(row, 0)) - Lanes::load(points.col(0).data() + j),
                y = Lanes::fill(points(row, 1)) - Lanes::load(points.col(1).data() + j),
                z = Lanes::fill(points(row, 2)) - Lanes::load(points.col(2).data() + j);
    return square_root(x * x + y * y + z * z);
  }

  /// One bit for each of eight rows from j on.
  HWY_INLINE std::uint64_t consistent(int j, double tolerance, double shortest) const {
    const Lanes source = from(matches.source_points, j), target = from(matches.target_points, j);
    return bits(magnitude(source - target) < Lanes::fill(tolerance)) & bits(Lanes::fill(shortest) < source + target);
  }
  std::uint64_t is_consistent(int j, double tolerance, double shortest) const {
    const PairDistances lengths = pair_distances(matches, row, j);
    return std::abs(lengths.source - lengths.target) < tolerance && shortest < lengths.source + lengths.target;
  }
};

/// The bits of the rows from `start`, a multiple of 64, on; that of the row itself may be set.
HWY_FLATTEN void compare_from(const CorrespondenceSet& matches, int row, int start, double tolerance, double shortest,
                              std::uint64_t* words) {
  const Lengths lengths{matches, row};
  for (int first = start; first < matches.size(); first += 64) {
    std::uint64_t word = 0;
    for (int j = first; j < first + 64 && j < matches.size(); j += kLanes) {
      if (j + kLanes <= matches.size())
        word |= lengths.consistent(j, tolerance, shortest) << (j - first);
      else
        for (int k = j; k < matches.size(); ++k) word |= lengths.is_consistent(k, tolerance, shortest) << (k - first);
    }
    words[first / 64] = word;
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

HWY_EXPORT(count_bits_in_both);
HWY_EXPORT(count_common);
HWY_EXPORT(add_common);
HWY_EXPORT(compare_from);

int BitGraph::count_in_both(const Word* a, const Word* b, int words) {
  return HWY_DYNAMIC_DISPATCH(count_bits_in_both)(a, b, words);
}

int BitGraph::degree(int node, int first, int last) const {
  return count_in_both(neighbors(node) + first, neighbors(node) + first, last - first);
}

void BitGraph::count_common(int node, const Indices& others, int* counts) const {
  HWY_DYNAMIC_DISPATCH(count_common)(*this, node, others, counts);
}

BitGraph::BlockEdges::BlockEdges(const BitGraph& graph, const NodeBlock& block, Others side)
    : first_(64 * block.first), start_(side == Others::Behind ? first_ : 0) {
  const int wanted = static_cast<int>(block.wanted.size()),
            end = side == Others::Behind ? wanted : std::min(wanted, 64 * block.last);
  for (int j = start_; j < end; ++j) {
    const std::size_t start = bits_.size();
    bits_.resize(start + kBlock);
    if (block.wanted[static_cast<std::size_t>(j)] == 0) continue;
    for (int word = block.first; word < block.last; ++word) {
      const Word in_front = word < j >> 6 ? ~Word{0} : word > j >> 6 ? 0 : (Word{1} << (j & 63)) - 1;
      const auto place = static_cast<std::size_t>(word - block.first);
      Word& nodes = bits_[start + place];
      nodes = graph.neighbors(j)[word] & block.nodes[place] & (side == Others::Behind ? in_front : ~in_front);
      size_ += hwy::PopCount(nodes);
    }
  }
}

void BitGraph::count_common(const BlockEdges& edges, int least, std::vector<int>& counts) const {
  counts.assign(edges.size(), 0);
  const int first = edges.first(), last = std::min(first + kNodesOfBlock, nodes_);
  Strip strip;
  for (int node = first; node < last; ++node) strip.rest.push_back(degree(node));
  for (strip.word = 0; strip.word < words_; strip.word += kStrip) {
    strip.words = std::min(kStrip, words_ - strip.word);
    strip.rows.clear(), strip.degrees.clear();
    for (int node = first; node < last; ++node) {
      const Word* const row = neighbors(node) + strip.word;
      strip.rows.insert(strip.rows.end(), row, row + strip.words);
      strip.degrees.push_back(degree(node, strip.word, strip.word + strip.words));
    }
    HWY_DYNAMIC_DISPATCH(add_common)(*this, edges, strip, least, counts.data());
    for (std::size_t node = 0; node < strip.rest.size(); ++node) strip.rest[node] -= strip.degrees[node];
  }
}

namespace {

/// Exchanges rows and columns of 64 x 64 bits: of ever smaller blocks those beside the diagonal.
void transpose(BitGraph::Word (&block)[64]) {
  BitGraph::Word mask = 0x00000000FFFFFFFF;
  for (int side = 32; side > 0; side /= 2, mask ^= mask << side)
    for (int row = 0; row < 64; row = (row + side + 1) & ~side) {
      const BitGraph::Word moved = (block[row] >> side ^ block[row + side]) & mask;
      block[row] ^= moved << side;
      block[row + side] ^= moved;
    }
}

}  // namespace

/// In strips of 64 rows, of which whole blocks are mirrored.
BitGraph consistency_graph(const CorrespondenceSet& matches, double tolerance, double shortest) {
  BitGraph graph(matches.size());
  const auto words = static_cast<std::size_t>(graph.words());
  std::vector<BitGraph::Word> strip(64 * words);
  for (int first = 0; first < graph.size(); first += 64) {
    const int rows = std::min(64, graph.size() - first);
    std::fill(strip.begin(), strip.end(), 0);
    for (int row = 0; row < rows; ++row) {
      BitGraph::Word* const of_row = &strip[static_cast<std::size_t>(row) * words];
      HWY_DYNAMIC_DISPATCH(compare_from)(matches, first + row, first, tolerance, shortest, of_row);
      of_row[first / 64] &= ~(BitGraph::Word{1} << row);
    }
    const auto diagonal = static_cast<std::size_t>(first / 64);
    for (std::size_t word = diagonal; word < words; ++word) {
      BitGraph::Word block[64];
      for (std::size_t row = 0; row < 64; ++row) block[row] = strip[row * words + word];
      for (int row = 0; row < rows; ++row) graph.bits_[graph.start(first + row) + word] = block[row];
      transpose(block);
      const int behind = static_cast<int>(64 * word);
      for (int row = 0; row < 64 && behind + row < graph.size(); ++row)
        graph.bits_[graph.start(behind + row) + diagonal] |= block[row];
    }
  }
  return graph;
}

Indices sampled_degrees(const CorrespondenceSet& matches, double tolerance, double shortest, int sample) {
  Indices degrees(static_cast<std::size_t>(matches.size()));
  std::vector<BitGraph::Word> near((degrees.size() + 63) / 64);
  for (int k = 0; k < sample; ++k) {
    const auto row = static_cast<int>(std::int64_t{k} * matches.size() / sample);
    HWY_DYNAMIC_DISPATCH(compare_from)(matches, row, 0, tolerance, shortest, near.data());
    BitGraph::for_bits(near.data(), static_cast<int>(near.size()),
                       [&](int other) { ++degrees[static_cast<std::size_t>(other)]; });
  }
  return degrees;
}

}  // namespace corral
#endif
