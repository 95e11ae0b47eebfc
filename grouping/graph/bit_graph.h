// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/correspondence_set.h"

namespace corral {

/// An undirected graph without loops whose nodes are the rows of a table: one bit for each ordered pair.
class BitGraph {
 public:
  using Word = std::uint64_t;

  explicit BitGraph(int nodes)
      : nodes_(nodes),
        words_((nodes + 63) / 64),
        bits_(static_cast<std::size_t>(nodes) * static_cast<std::size_t>(words_)) {}

  /// Bytes for so many nodes.
  static double memory(int nodes) { return (nodes + 63) / 64 * 8.0 * nodes; }

  int size() const { return nodes_; }
  int words() const { return words_; }  ///< of a node
  const Word* neighbors(int node) const { return &bits_[start(node)]; }
  bool is_edge(int a, int b) const { return neighbors(a)[b >> 6] >> (b & 63) & 1; }
  void connect(int a, int b) { set(a, b), set(b, a); }
  void disconnect(int a, int b) { clear(a, b), clear(b, a); }
  int degree(int node) const { return degree(node, 0, words_); }
  int degree(int node, int first, int last) const;                    ///< in the words from `first` to before `last`
  static int count_in_both(const Word* a, const Word* b, int words);  ///< bits that are set in both

  /// Some nodes of a range, and others.
  struct NodeBlock {
    int first, last;           ///< words: the range is from node 64 first to before 64 last
    std::vector<Word> nodes;   ///< a bit for each node of the range
    std::vector<char> wanted;  ///< for each node from 0 on, not 0 if it is among the others
  };
  enum class Others { Behind, InFront };  ///< of the node of a block that they are an edge with

  /// The edges between nodes of a block and others, on one side of them.
  class BlockEdges {
   public:
    BlockEdges(const BitGraph& graph, const NodeBlock& block, Others side);
    std::size_t size() const { return size_; }
    int first() const { return first_; }  ///< node of the range

    /// Calls visit(i, j) for every edge, node i of the block. In the order of j, then i.
    template <class Visit>
    void for_each(Visit&& visit) const {
      int j = start_;
      for (auto words = bits_.begin(); words != bits_.end(); ++j)
        for (int start = first_; start < first_ + kNodesOfBlock; start += 64, ++words)
          for (Word rest = *words; rest != 0; rest &= rest - 1) visit(start + lowest(rest), j);
    }

   private:
    int first_, start_;
    std::size_t size_ = 0;
    std::vector<Word> bits_;  ///< for each node from `start` on, which of the block it is an edge with
  };

  /// Some words of the rows of all nodes of a range.
  struct Strip {
    int word, words;         ///< the first of them, and how many
    std::vector<Word> rows;  ///< one node behind the other
    Indices degrees, rest;   ///< of each node: in these words; in these and those that follow
  };
  // The rows of a range fit into the cache, a strip at a time.
  static constexpr int kBlock = 8;    ///< words of a range
  static constexpr int kStrip = 128;  ///< words of a strip
  static constexpr int kNodesOfBlock = 64 * kBlock;
  /// Bytes for the counts of a block of at most so many edges.
  static double memory_of_block(int nodes, double edges) {
    const double strip =
        std::min(1.0 * kNodesOfBlock, 1.0 * nodes) * std::min(1.0 * kStrip, nodes / 64.0 + 1) * sizeof(Word);
    return 4 * std::min(edges, nodes * (nodes - 1.0) / 2) + strip + nodes * (1 + 8.0 * kBlock) + 8 * kNodesOfBlock;
  }

  /// counts[k] = the number of common neighbours of `node` and others[k].
  void count_common(int node, const Indices& others, int* counts) const;

  /// counts[k] = the number of common neighbours of the ends of edge k; where that is less than `least`, that number
  /// or less. The rows of a block stay in the cache while those of all others pass by.
  void count_common(const BlockEdges& edges, int least, std::vector<int>& counts) const;

  /// Calls visit(j) for every neighbour j of the node, ascending.
  template <class Visit>
  void for_neighbors(int node, Visit&& visit) const {
    for_bits(neighbors(node), words_, visit);
  }
  template <class Visit>
  static void for_bits(const Word* bits, int words, Visit&& visit) {
    for (int word = 0; word < words; ++word)
      for (Word rest = bits[word]; rest != 0; rest &= rest - 1) visit(64 * word + lowest(rest));
  }

 private:
  friend BitGraph consistency_graph(const CorrespondenceSet&, double, double);
  friend class InducedSubgraphs;
  /// The place of the lowest bit that is set, by a de Bruijn sequence: all 64 windows of six bits of it differ.
  static int lowest(Word word) {
    constexpr std::uint8_t kPlaces[64] = {0,  1,  2,  53, 3,  7,  54, 27, 4,  38, 41, 8,  34, 55, 48, 28,
                                          62, 5,  39, 46, 44, 42, 22, 9,  24, 35, 59, 56, 49, 18, 29, 11,
                                          63, 52, 6,  26, 37, 40, 33, 47, 61, 45, 43, 21, 23, 58, 17, 10,
                                          51, 25, 36, 32, 60, 20, 57, 16, 50, 31, 19, 15, 30, 14, 13, 12};
    return kPlaces[((word & (~word + 1)) * 0x022FDD63CC95386D) >> 58];
  }
  std::size_t start(int node) const { return static_cast<std::size_t>(node) * static_cast<std::size_t>(words_); }
  void set(int from, int to) { bits_[start(from) + static_cast<std::size_t>(to >> 6)] |= Word{1} << (to & 63); }
  void clear(int from, int to) { bits_[start(from) + static_cast<std::size_t>(to >> 6)] &= ~(Word{1} << (to & 63)); }

  int nodes_, words_;
  std::vector<Word> bits_;
};

/// Which rows keep their distance to one another, tolerance and shortest length in mesh units:
///
///   G_ij = [ | |p_i - p_j| - |p'_i - p'_j| | < tolerance  and  |p_i - p_j| + |p'_i - p'_j| > shortest ],   i != j
///
/// Cost      O(M^2) time.
BitGraph consistency_graph(const CorrespondenceSet& matches, double tolerance, double shortest = -1);

/// To how many of `sample` rows at even steps each row is an edge of that graph, itself perhaps among them.
Indices sampled_degrees(const CorrespondenceSet& matches, double tolerance, double shortest, int sample);

}  // namespace corral
