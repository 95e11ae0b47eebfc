// SPDX-License-Identifier: MIT
#include "grouping/graph/core_numbers.h"

#include <algorithm>
#include <utility>

namespace corral {
namespace {

/// The nodes that are left, by degree: those of one degree stand together. Where the node removed has an edge with more than half of
/// them, every node left counts as one that lost an edge, and the others get it back: a degree is a key less the number of such
/// removals, and `first[key]` is where the nodes of a key begin.
class Peeling {
 public:
  explicit Peeling(const BitGraph& graph)
      : graph_(graph),
        keys_(count()),
        order_(count()),
        places_(count()),
        first_(count() + 1),
        left_(static_cast<std::size_t>(graph.words())) {
    for (std::size_t v = 0; v < count(); ++v) keys_[v] = graph.degree(static_cast<int>(v));
    for (const int key : keys_) ++first_[static_cast<std::size_t>(key) + 1];
    for (std::size_t key = 1; key < first_.size(); ++key) first_[key] += first_[key - 1];
    Indices next = first_;
    for (std::size_t v = 0; v < count(); ++v) {
      places_[v] = next[static_cast<std::size_t>(keys_[v])]++;
      order_[static_cast<std::size_t>(places_[v])] = static_cast<int>(v);
      left_[v >> 6] |= BitGraph::Word{1} << (v & 63);
    }
  }

  CoreNumbers run() {
    Indices numbers(count());
    int number = 0;
    while (removed_ < graph_.size()) {
      const int node = order_[static_cast<std::size_t>(removed_++)], left = graph_.size() - removed_;
      const int degree = keys_[static_cast<std::size_t>(node)] - lost_by_all_;
      numbers[static_cast<std::size_t>(node)] = number = std::max(number, degree);
      left_[static_cast<std::size_t>(node >> 6)] &= ~(BitGraph::Word{1} << (node & 63));
      if (2 * degree <= left) {
        for_left(node, 0, [&](int other) { lower(other); });
      } else {
        ++lost_by_all_;
        for_left(node, ~BitGraph::Word{0}, [&](int other) { raise(other); });
      }
    }
    return {std::move(numbers), std::move(order_)};
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(graph_.size()); }

  /// The nodes left that are an edge with this one, or with all bits to flip those that are none.
  template <class Visit>
  void for_left(int node, BitGraph::Word flip, Visit&& visit) const {
    for (int word = 0; word < graph_.words(); ++word) {
      const BitGraph::Word others = (graph_.neighbors(node)[word] ^ flip) & left_[static_cast<std::size_t>(word)];
      BitGraph::for_bits(&others, 1, [&](int bit) { visit(64 * word + bit); });
    }
  }

  /// Moves a node to the front of those of its key, and their beginning behind it.
  void lower(int node) {
    int& first = first_[static_cast<std::size_t>(keys_[static_cast<std::size_t>(node)]--)];
    first = std::max(first, removed_);
    move(node, first++);
  }

  /// Moves a node to the end of those of its key, and the beginning of the next in front of it.
  void raise(int node) {
    int& first = first_[static_cast<std::size_t>(++keys_[static_cast<std::size_t>(node)])];
    move(node, --first);
  }

  void move(int node, int to) {
    int& place = places_[static_cast<std::size_t>(node)];
    const int displaced = order_[static_cast<std::size_t>(to)];
    std::swap(order_[static_cast<std::size_t>(to)], order_[static_cast<std::size_t>(place)]);
    places_[static_cast<std::size_t>(displaced)] = place;
    place = to;
  }

  const BitGraph& graph_;
  Indices keys_, order_, places_, first_;
  std::vector<BitGraph::Word> left_;   ///< a bit for each node
  int removed_ = 0, lost_by_all_ = 0;  ///< nodes; edges
};

}  // namespace

CoreNumbers core_numbers(const BitGraph& graph) { return Peeling(graph).run(); }

}  // namespace corral
