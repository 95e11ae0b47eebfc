// SPDX-License-Identifier: MIT
#include "grouping/graph/maximal_cliques.h"

#include <hwy/base.h>

#include <algorithm>
#include <numeric>

#include "grouping/graph/core_numbers.h"
#include "grouping/graph/induced_subgraph.h"

namespace corral {
namespace {

using Word = BitGraph::Word;
using Bits = std::vector<Word>;

class Enumeration {
 public:
  Enumeration(const BitGraph& graph, int smallest, std::int64_t max_steps,
              const std::function<void(const Indices&)>& visit)
      : names_(core_numbers(graph).order),
        graph_(InducedSubgraphs(graph)(names_)),
        smallest_(static_cast<std::size_t>(smallest)),
        max_steps_(max_steps),
        visit_(visit) {}

  std::optional<std::int64_t> run() {
    InducedSubgraphs induced(graph_);
    for (int node = 0; node < graph_.size(); ++node) {
      Indices neighbors;
      graph_.for_neighbors(node, [&](int other) { neighbors.push_back(other); });
      const auto later = std::upper_bound(neighbors.begin(), neighbors.end(), node);
      if (static_cast<std::size_t>(neighbors.end() - later) + 1 < smallest_) continue;
      clique_ = {names_[static_cast<std::size_t>(node)]};
      if (2 * static_cast<int>(neighbors.size()) > graph_.size()) {  // a graph of the neighbours would be no smaller
        start(graph_, neighbors, node);
        if (!extend(graph_, names_, 0)) return std::nullopt;
        continue;
      }
      const BitGraph subgraph = induced(neighbors);
      const int first_later = static_cast<int>(later - neighbors.begin());
      Indices places(neighbors.size());
      std::iota(places.begin(), places.end(), 0);
      start(subgraph, places, first_later);
      for (int& neighbor : neighbors) neighbor = names_[static_cast<std::size_t>(neighbor)];
      if (!extend(subgraph, neighbors, 0)) return std::nullopt;
    }
    return steps_;
  }

 private:
  struct Level {
    Bits candidates, excluded, branches;  ///< P, X, and P without the neighbours of the pivot
  };

  /// Neighbours of the first node, by their places in a graph: from `first_later` on they may join, those before are excluded.
  void start(const BitGraph& graph, const Indices& neighbors, int first_later) {
    const std::size_t words = static_cast<std::size_t>(graph.words());
    if (levels_.empty()) levels_.resize(1);
    levels_[0].candidates.assign(words, 0);
    levels_[0].excluded.assign(words, 0);
    for (const int place : neighbors)
      (place < first_later ? levels_[0].excluded : levels_[0].candidates)[static_cast<std::size_t>(place >> 6)] |=
          Word{1} << (place & 63);
  }

  bool extend(const BitGraph& subgraph, const Indices& names, std::size_t depth) {
    if (++steps_ > max_steps_) return false;
    if (levels_.size() < depth + 2) levels_.resize(depth + 2);
    const auto size = static_cast<std::size_t>(subgraph.words());
    if (!choose_branches(subgraph, levels_[depth])) {
      report(levels_[depth]);
      return true;
    }
    for (std::size_t word = 0; word < size; ++word)
      while (levels_[depth].branches[word] != 0) {
        const int bit = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(levels_[depth].branches[word]));
        const int next = 64 * static_cast<int>(word) + bit;
        Level &level = levels_[depth], &deeper = levels_[depth + 1];
        deeper.candidates.resize(size), deeper.excluded.resize(size);
        for (std::size_t k = 0; k < size; ++k) {
          deeper.candidates[k] = level.candidates[k] & subgraph.neighbors(next)[k];
          deeper.excluded[k] = level.excluded[k] & subgraph.neighbors(next)[k];
        }
        clique_.push_back(names[static_cast<std::size_t>(next)]);
        if (!extend(subgraph, names, depth + 1)) return false;
        clique_.pop_back();
        const Word mark = Word{1} << bit;
        levels_[depth].branches[word] &= ~mark;
        levels_[depth].candidates[word] &= ~mark;
        levels_[depth].excluded[word] |= mark;
      }
    return true;
  }

  /// False if there is no candidate.
  static bool choose_branches(const BitGraph& subgraph, Level& level) {
    int pivot = -1, most = -1;
    const int words = subgraph.words();
    Word any = 0;
    for (std::size_t word = 0; word < level.candidates.size(); ++word) {
      any |= level.candidates[word];
      const Word either = level.candidates[word] | level.excluded[word];
      BitGraph::for_bits(&either, 1, [&](int bit) {
        const int node = 64 * static_cast<int>(word) + bit;
        const int count = BitGraph::count_in_both(level.candidates.data(), subgraph.neighbors(node), words);
        if (count > most) most = count, pivot = node;
      });
    }
    if (any == 0) return false;
    level.branches = level.candidates;
    for (std::size_t k = 0; k < level.branches.size(); ++k) level.branches[k] &= ~subgraph.neighbors(pivot)[k];
    return true;
  }

  void report(const Level& level) {
    if (clique_.size() < smallest_) return;
    if (std::all_of(level.excluded.begin(), level.excluded.end(), [](Word word) { return word == 0; })) visit_(clique_);
  }

  const Indices names_;  ///< of the caller, in the order of removal; here they are 0, 1, ...
  const BitGraph graph_;
  const std::size_t smallest_;
  const std::int64_t max_steps_;
  const std::function<void(const Indices&)>& visit_;
  std::vector<Level> levels_;
  Indices clique_;
  std::int64_t steps_ = 0;
};

}  // namespace

std::optional<std::int64_t> visit_maximal_cliques(const BitGraph& graph, int smallest, std::int64_t max_steps,
                                                  const std::function<void(const Indices&)>& visit) {
  return Enumeration(graph, smallest, max_steps, visit).run();
}

double maximal_cliques_memory(int nodes) {
  // Peeling and lists, the graph in another order, that of the neighbours of a node, and three sets for each node of a clique.
  return 40.0 * nodes + InducedSubgraphs::memory(nodes) + 5 * BitGraph::memory(nodes) + 4096;
}

}  // namespace corral
