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
  int degree(int node, int first, int last) const;  ///< in the words from `first` to before `last`

  /// Some nodes of a range, and those that count as their neighbours.
  struct NodeBlock {
    int first, last;           ///< words: the range is from node 64 first to before 64 last
    int end;                   ///< nodes from here on do not count
    std::vector<Word> nodes;   ///< a bit for each node of the range
    std::vector<char> wanted;  ///< for each node of the graph below `end`, not 0 if it counts
  };
  // The rows of a range fit into the cache, a strip at a time.
  static constexpr int kBlock = 8;    ///< words of a range
  static constexpr int kStrip = 128;  ///< words of a strip
  /// Bytes for the counts of a block of at most so many edges.
  static double memory_of_block(int nodes, double edges) {
    const double strip = std::min(64.0 * kBlock, 1.0 * nodes) * std::min(1.0 * kStrip, nodes / 64.0 + 1) * sizeof(Word);
    return 4 * std::min(edges, nodes * (nodes - 1.0) / 2) + strip + nodes;
  }

  /// counts[k] = the number of common neighbours of `node` and others[k].
  void count_common(int node, const Indices& others, int* counts) const;

  /// Calls visit(i, j) for every edge of a block: node i of the block, j behind it and below `end`, both `wanted`. In the order
  /// of j, then i.
  template <class Visit>
  void for_edges(const NodeBlock& block, Visit&& visit) const {
    for (int j = 64 * block.first + 1; j < block.end; ++j) {
      if (block.wanted[static_cast<std::size_t>(j)] == 0) continue;
      const int behind = std::min(block.last, (j >> 6) + 1);
      for (int word = block.first; word < behind; ++word) {
        Word nodes = neighbors(j)[word] & block.nodes[static_cast<std::size_t>(word - block.first)];
        if (word == j >> 6) nodes &= (Word{1} << (j & 63)) - 1;
        for (; nodes != 0; nodes &= nodes - 1) visit(64 * word + lowest(nodes), j);
      }
    }
  }

  /// counts[k] = the number of common neighbours of the ends of edge k of for_edges(). The rows of a block stay in the cache while
  /// those of all others pass by.
  void count_common(const NodeBlock& block, std::vector<int>& counts) const;

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
