// SPDX-License-Identifier: MIT
#include "grouping/graph/common_neighbors.h"

#include <hwy/base.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grouping/graph/common_neighbors.cpp"
#include <hwy/foreach_target.h>

#include "kernel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corral::HWY_NAMESPACE {
namespace {

using Word = BitGraph::Word;
constexpr std::size_t kTogether = 15;  // rows whose sums four digits hold
constexpr int kSlices = CommonNeighbors::kSlices;
constexpr std::size_t kChunk = CommonNeighbors::kChunk;
constexpr std::size_t kMostAdded = ((std::size_t{1} << kSlices) - 1) / kTogether * kTogether;

/// Sums of single bits, the digits of each in as many slices.
using Slices = Word[kSlices][kChunk];

template <class Bits>
struct Digits {
  Bits sum, carry;
};
template <class Bits>
HWY_INLINE Digits<Bits> add(Bits a, Bits b, Bits c) {
  const Bits either = hn::Xor(a, b);
  return {hn::Xor(either, c), hn::Or(hn::And(a, b), hn::And(either, c))};
}

/// Adds 15 rows to the slices, in the words of one register.
template <class Tag>
HWY_INLINE void add_rows(Tag tag, const Word* const (&rows)[kTogether], std::size_t word, Slices& slices) {
  const auto row = [&](std::size_t k) HWY_ATTR { return hn::LoadU(tag, rows[k] + word); };
  const auto a = add(row(0), row(1), row(2)), b = add(row(3), row(4), row(5)), c = add(row(6), row(7), row(8)),
             d = add(row(9), row(10), row(11)), e = add(row(12), row(13), row(14));
  const auto abc = add(a.sum, b.sum, c.sum), ones = add(abc.sum, d.sum, e.sum);
  const auto f = add(a.carry, b.carry, c.carry), g = add(d.carry, e.carry, abc.carry),
             twos = add(f.sum, g.sum, ones.carry), fours = add(f.carry, g.carry, twos.carry);
  const decltype(hn::Zero(tag)) digits[4] = {ones.sum, twos.sum, fours.sum, fours.carry};
  auto carry = hn::Zero(tag);
  for (int k = 0; k < 4; ++k) {
    const auto digit = add(hn::LoadU(tag, slices[k] + word), digits[k], carry);
    hn::StoreU(digit.sum, tag, slices[k] + word);
    carry = digit.carry;
  }
  for (int k = 4; k < kSlices; ++k) {
    const auto slice = hn::LoadU(tag, slices[k] + word);
    hn::StoreU(hn::Xor(slice, carry), tag, slices[k] + word);
    carry = hn::And(slice, carry);
  }
}

/// counts += sign times the sums of so many words.
HWY_INLINE void write_sums(const Slices& slices, std::size_t words, int sign, int* counts) {
  const hn::CappedTag<std::int32_t, 16> tag;
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t word = 0; word < words; ++word)
    for (std::size_t bit = 0; bit < 64; bit += lanes, counts += lanes) {
      auto sum = hn::LoadU(tag, counts);
      for (int k = 0; k < kSlices; ++k) {
        const Word part = slices[k][word] >> bit;
        const auto named = hn::LoadMaskBits(tag, reinterpret_cast<const std::uint8_t*>(&part));
        sum = hn::Add(sum, hn::IfThenElseZero(named, hn::Set(tag, sign * (1 << k))));
      }
      hn::StoreU(sum, tag, counts);
    }
}

/// counts[j - 64 first] += sign times the number of those of `nodes` that are neighbours of j.
HWY_FLATTEN void add_neighbors(const BitGraph& graph, const Indices& nodes, int sign, int first, int last,
                               int* counts) {
  static constexpr Word kNothing[kChunk] = {};
  const hn::CappedTag<Word, 8> tag;
  const hn::CappedTag<Word, 1> one;
  const std::size_t lanes = hn::Lanes(tag);
  Slices slices;
  for (int chunk = first; chunk < last; chunk += static_cast<int>(kChunk)) {
    const std::size_t words = std::min(kChunk, static_cast<std::size_t>(last - chunk));
    for (std::size_t done = 0; done < nodes.size();) {
      const std::size_t end = std::min(nodes.size(), done + kMostAdded);
      for (auto& slice : slices) std::fill(slice, slice + words, 0);
      while (done < end) {
        const Word* rows[kTogether];
        for (const Word*& row : rows) row = done < end ? graph.neighbors(nodes[done++]) + chunk : kNothing;
        std::size_t word = 0;
        for (; word + lanes <= words; word += lanes) add_rows(tag, rows, word, slices);
        for (; word < words; ++word) add_rows(one, rows, word, slices);
      }
      write_sums(slices, words, sign, counts + 64 * (chunk - first));
    }
  }
}

HWY_FLATTEN void find_at_least(const int* counts, int fewest, std::size_t words, Word* found) {
  const hn::CappedTag<std::int32_t, 16> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const auto least = hn::Set(tag, fewest - 1);
  for (std::size_t word = 0; word < words; ++word) {
    found[word] = 0;
    for (std::size_t bit = 0; bit < 64; bit += lanes, counts += lanes) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(tag, hn::Gt(hn::LoadU(tag, counts), least), bytes);
      Word part;
      hwy::CopyBytes<sizeof(part)>(bytes, &part);
      found[word] |= (part & ((Word{1} << lanes) - 1)) << bit;
    }
  }
}

}  // namespace
}  // namespace corral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corral {

using Word = BitGraph::Word;

HWY_EXPORT(add_neighbors);
HWY_EXPORT(find_at_least);

CommonNeighbors::CommonNeighbors(const BitGraph& graph)
    : graph_(graph), dense_(static_cast<std::size_t>(graph.words())) {
  const auto nodes = static_cast<std::size_t>(graph.size());
  for (int node = 0; node < graph.size(); ++node) degrees_.push_back(graph.degree(node));
  const int most = nodes == 0 ? 0 : *std::max_element(degrees_.begin(), degrees_.end());
  for (int node = 0; node < graph.size(); ++node)
    if (2 * degree(node) > most) {
      dense_[static_cast<std::size_t>(node >> 6)] |= Word{1} << (node & 63);
      ++dense_nodes_;
    }
  for (int node = 0; node < graph.size(); ++node)
    in_dense_.push_back(BitGraph::count_in_both(graph.neighbors(node), dense_.data(), graph.words()));
  in_dense_.resize(64 * dense_.size());
  added_.reserve(nodes), removed_.reserve(nodes);
  counts_.reserve(in_dense_.size());
}

/// A word that is added takes nearly twice the time of one that is compared.
bool CommonNeighbors::is_faster(int node, int first, int last, int others) const {
  const int different = degree(node) + dense_nodes_ - 2 * in_dense_[static_cast<std::size_t>(node)];  // from those in H
  const auto added = static_cast<std::size_t>(std::min(different, degree(node)));
  return 7 * added * static_cast<std::size_t>(last - first) < 4 * static_cast<std::size_t>(others) * dense_.size();
}

const std::vector<int>& CommonNeighbors::count(int node, int first, int last) {
  const Word* const neighbors = graph_.neighbors(node);
  added_.clear(), removed_.clear();
  for (int word = 0; word < graph_.words(); ++word) {
    const Word dense = dense_[static_cast<std::size_t>(word)], added = neighbors[word] & ~dense,
               removed = dense & ~neighbors[word];
    BitGraph::for_bits(&added, 1, [&](int bit) { added_.push_back(64 * word + bit); });
    BitGraph::for_bits(&removed, 1, [&](int bit) { removed_.push_back(64 * word + bit); });
  }
  const auto add = [&](const Indices& nodes, int sign) {
    HWY_DYNAMIC_DISPATCH(add_neighbors)(graph_, nodes, sign, first, last, counts_.data());
  };
  if (static_cast<int>(added_.size() + removed_.size()) < degree(node)) {
    counts_.assign(in_dense_.begin() + 64 * first, in_dense_.begin() + 64 * last);
    add(removed_, -1);
  } else {
    counts_.assign(64 * static_cast<std::size_t>(last - first), 0);
    added_.clear();
    graph_.for_neighbors(node, [&](int other) { added_.push_back(other); });
  }
  add(added_, 1);
  return counts_;
}

void CommonNeighbors::find(int fewest, std::vector<Word>& found) const {
  found.resize(counts_.size() / 64);
  HWY_DYNAMIC_DISPATCH(find_at_least)(counts_.data(), fewest, found.size(), found.data());
}

}  // namespace corral
#endif
