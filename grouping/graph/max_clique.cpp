// SPDX-License-Identifier: MIT
#include "grouping/graph/max_clique.h"

#include <hwy/base.h>

#include <algorithm>
#include <numeric>

#include "grouping/graph/core_numbers.h"
#include "grouping/graph/induced_subgraph.h"

namespace corral {
namespace {

using Word = BitGraph::Word;

int count_bits(const std::vector<Word>& words) {
  int count = 0;
  for (const Word word : words) count += static_cast<int>(hwy::PopCount(word));
  return count;
}

int lowest(Word word) { return static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(word)); }

}  // namespace

MaxCliqueSearch::MaxCliqueSearch(const BitGraph& graph) : graph_(0) {
  CoreNumbers cores = core_numbers(graph);
  names_ = std::move(cores.order);
  std::reverse(names_.begin(), names_.end());
  for (const int name : names_) cores_.push_back(cores.numbers[static_cast<std::size_t>(name)]);
  graph_ = InducedSubgraphs(graph)(names_);
  all_.resize(names_.size());
  std::iota(all_.begin(), all_.end(), 0);
}

double MaxCliqueSearch::memory(int nodes) {
  // Peeling, lists, the graph in another order, that of the candidates, and a level for each node of a clique.
  return 444.0 * nodes + InducedSubgraphs::memory(nodes) + 2.5 * BitGraph::memory(nodes) + 4096;
}

std::optional<Indices> MaxCliqueSearch::find_one(std::int64_t max_steps) {
  Indices best;
  for (int node = 0; node < graph_.size(); ++node) {
    if (cores_[static_cast<std::size_t>(node)] < static_cast<int>(best.size())) break;
    Indices grown = grow_from(node);
    if (grown.size() > best.size()) best = std::move(grown);
  }
  best = names_of(best);
  needed_ = static_cast<int>(best.size()) + 1;
  found_ = [&] {
    Indices nodes{node_};
    for (const int place : clique_) nodes.push_back(candidates_[static_cast<std::size_t>(place)]);
    best = names_of(nodes);
    needed_ = static_cast<int>(best.size()) + 1;
  };
  if (!search(max_steps)) return std::nullopt;
  return best;
}

bool MaxCliqueSearch::visit_all(int size, std::int64_t max_steps, const Visit& visit) {
  needed_ = size;
  found_ = [&] {
    Indices nodes{node_};
    for (const int place : clique_) nodes.push_back(candidates_[static_cast<std::size_t>(place)]);
    visit(names_of(nodes));
  };
  return search(max_steps);
}

/// Of the neighbours of all nodes so far the first, which has the largest core number.
Indices MaxCliqueSearch::grow_from(int node) const {
  Indices clique{node};
  std::vector<Word> common(graph_.neighbors(node), graph_.neighbors(node) + graph_.words());
  for (std::size_t word = 0; word < common.size();) {
    if (common[word] == 0) {
      ++word;
      continue;
    }
    const int next = 64 * static_cast<int>(word) + lowest(common[word]);
    clique.push_back(next);
    for (std::size_t k = word; k < common.size(); ++k) common[k] &= graph_.neighbors(next)[k];
  }
  return clique;
}

bool MaxCliqueSearch::search(std::int64_t max_steps) {
  steps_ = 0, max_steps_ = max_steps;
  InducedSubgraphs induced(graph_);
  for (node_ = 0; node_ < graph_.size(); ++node_) {
    if (cores_[static_cast<std::size_t>(node_)] + 1 < needed_) break;  // so are all that follow
    candidates_ = candidates_of(node_);
    if (static_cast<int>(candidates_.size()) + 1 < needed_) continue;
    if (++steps_ > max_steps_) return false;
    if (candidates_.empty()) {
      found_();
      continue;
    }
    if (levels_.size() < candidates_.size() + 1) levels_.resize(candidates_.size() + 1);
    if (2 * static_cast<int>(candidates_.size()) > graph_.size()) {  // a graph of the candidates would be no smaller
      set_candidates(graph_);
      candidates_ = all_;
      if (!expand(graph_, 0)) return false;
      continue;
    }
    const BitGraph subgraph = induced(candidates_);
    levels_[0].candidates.assign(static_cast<std::size_t>(subgraph.words()), ~Word{0});
    if (subgraph.size() % 64 != 0) levels_[0].candidates.back() = (Word{1} << subgraph.size() % 64) - 1;
    if (!expand(subgraph, 0)) return false;
  }
  return true;
}

void MaxCliqueSearch::set_candidates(const BitGraph& graph) {
  std::vector<Word>& words = levels_[0].candidates;
  words.assign(static_cast<std::size_t>(graph.words()), 0);
  for (const int node : candidates_) words[static_cast<std::size_t>(node >> 6)] |= Word{1} << (node & 63);
}

/// The neighbours removed later that have enough neighbours in common with the node.
Indices MaxCliqueSearch::candidates_of(int node) const {
  Indices later, kept;
  graph_.for_neighbors(node, [&](int other) {
    if (other < node) later.push_back(other);
  });
  if (static_cast<int>(later.size()) + 1 < needed_) return {};
  Indices common(later.size());
  graph_.count_common(node, later, common.data());
  for (std::size_t k = 0; k < later.size(); ++k)
    if (common[k] + 2 >= needed_) kept.push_back(later[k]);
  return kept;
}

bool MaxCliqueSearch::expand(const BitGraph& graph, std::size_t depth) {
  Level& level = levels_[depth];
  const int size = static_cast<int>(clique_.size()) + 1;  // with the node itself
  const int colors = color(graph, level, needed_ - size), count = count_bits(level.candidates);
  if (colors == count && size + count >= needed_) return take_all(level.candidates);
  for (std::size_t k = level.order.size(); k-- > 0;) {
    if (size + level.colors[k] < needed_) break;
    if (++steps_ > max_steps_) return clique_.clear(), false;
    const int next = level.order[k];
    std::vector<Word>& common = levels_[depth + 1].candidates;
    common.resize(level.candidates.size());
    Word any = 0;
    for (std::size_t word = 0; word < common.size(); ++word)
      any |= common[word] = level.candidates[word] & graph.neighbors(next)[word];
    clique_.push_back(next);
    if (any != 0) {
      if (!expand(graph, depth + 1)) return false;
    } else if (size + 1 >= needed_) {
      found_();
    }
    clique_.pop_back();
    level.candidates[static_cast<std::size_t>(next >> 6)] &= ~(Word{1} << (next & 63));
  }
  return true;
}

/// Every candidate has a colour of its own: it is a neighbour of all before it. The steps are those of one after the other.
bool MaxCliqueSearch::take_all(const std::vector<Word>& candidates) {
  const std::size_t before = clique_.size();
  BitGraph::for_bits(candidates.data(), static_cast<int>(candidates.size()),
                     [&](int node) { clique_.push_back(node); });
  steps_ += static_cast<std::int64_t>(clique_.size() - before);
  if (steps_ > max_steps_) return clique_.clear(), false;
  found_();
  clique_.resize(before);
  return true;
}

/// Gives each candidate the first colour that none of its neighbours has; keeps those of colour `least` or above, ascending. Returns the
/// number of colours.
int MaxCliqueSearch::color(const BitGraph& graph, Level& level, int least) const {
  level.order.clear(), level.colors.clear();
  level.uncolored = level.candidates;
  const std::size_t words = level.uncolored.size();
  std::size_t first = 0;
  for (int color = 1;; ++color) {
    while (first < words && level.uncolored[first] == 0) ++first;
    if (first == words) return color - 1;
    level.one_color = level.uncolored;
    for (std::size_t word = first; word < words; ++word) {
      while (level.one_color[word] != 0) {
        const int bit = lowest(level.one_color[word]), node = 64 * static_cast<int>(word) + bit;
        level.uncolored[word] &= ~(Word{1} << bit);
        level.one_color[word] &= ~(Word{1} << bit);
        const Word* neighbors = graph.neighbors(node);
        for (std::size_t k = word; k < words; ++k) level.one_color[k] &= ~neighbors[k];
        if (color >= least) level.order.push_back(node), level.colors.push_back(color);
      }
    }
  }
}

Indices MaxCliqueSearch::names_of(const Indices& nodes) const {
  Indices names;
  for (const int node : nodes) names.push_back(names_[static_cast<std::size_t>(node)]);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace corral
