// SPDX-License-Identifier: MIT
#include "grouping/graph/core_numbers.h"

#include <algorithm>
#include <utility>

namespace corral {
namespace {

/// The nodes that are left, by degree: those of one degree stand together and `first[degree]` is where they begin.
class Peeling {
 public:
  explicit Peeling(const BitGraph& graph)
      : graph_(graph),
        degrees_(count()),
        order_(count()),
        places_(count()),
        first_(count() + 1),
        left_(static_cast<std::size_t>(graph.words()), ~BitGraph::Word{0}) {
    for (std::size_t v = 0; v < count(); ++v) degrees_[v] = graph.degree(static_cast<int>(v));
    for (const int degree : degrees_) ++first_[static_cast<std::size_t>(degree) + 1];
    for (std::size_t degree = 1; degree < first_.size(); ++degree) first_[degree] += first_[degree - 1];
    Indices next = first_;
    for (std::size_t v = 0; v < count(); ++v) {
      places_[v] = next[static_cast<std::size_t>(degrees_[v])]++;
      order_[static_cast<std::size_t>(places_[v])] = static_cast<int>(v);
    }
  }

  CoreNumbers run() {
    for (std::size_t k = 0; k < count(); ++k) {
      const int node = order_[k];
      const int degree = degrees_[static_cast<std::size_t>(node)];
      left_[static_cast<std::size_t>(node >> 6)] &= ~(BitGraph::Word{1} << (node & 63));
      for (int word = 0; word < graph_.words(); ++word) {
        const BitGraph::Word others = graph_.neighbors(node)[word] & left_[static_cast<std::size_t>(word)];
        BitGraph::for_bits(&others, 1, [&](int bit) {
          const int other = 64 * word + bit;
          if (degrees_[static_cast<std::size_t>(other)] > degree) lower(other);
        });
      }
    }
    return {std::move(degrees_), std::move(order_)};
  }

 private:
  std::size_t count() const { return static_cast<std::size_t>(graph_.size()); }

  /// Moves a node to the front of those of its degree, and their beginning behind it.
  void lower(int node) {
    int& degree = degrees_[static_cast<std::size_t>(node)];
    int& place = places_[static_cast<std::size_t>(node)];
    const int front = first_[static_cast<std::size_t>(degree)]++;
    const int displaced = order_[static_cast<std::size_t>(front)];
    std::swap(order_[static_cast<std::size_t>(front)], order_[static_cast<std::size_t>(place)]);
    places_[static_cast<std::size_t>(displaced)] = place;
    place = front;
    --degree;
  }

  const BitGraph& graph_;
  Indices degrees_, order_, places_, first_;
  std::vector<BitGraph::Word> left_;  ///< a bit for each node
};

}  // namespace

CoreNumbers core_numbers(const BitGraph& graph) { return Peeling(graph).run(); }

}  // namespace corral
