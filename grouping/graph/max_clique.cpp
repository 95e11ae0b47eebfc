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
  return BitGraph::count_in_both(words.data(), words.data(), static_cast<int>(words.size()));
}

constexpr int kNodesOfLarge = 8192;  // a graph of so many loses edges in few triangles first
constexpr double kMostGrown = 4e9;   // words read to grow first cliques
constexpr int kWorkPerWord = 16;     // that is read to make a graph of candidates

int lowest(Word word) { return static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(word)); }

}  // namespace

/// The first clique is grown on the whole graph; what cannot be in a clique of its size is left out from then on.
MaxCliqueSearch::MaxCliqueSearch(const BitGraph& graph, std::int64_t work_per_step)
    : whole_(graph), work_per_step_(work_per_step), common_(graph), graph_(0), missing_(graph_) {
  CoreNumbers cores = core_numbers(graph);
  names_ = std::move(cores.order);
  std::reverse(names_.begin(), names_.end());
  for (const int name : names_) cores_.push_back(cores.numbers[static_cast<std::size_t>(name)]);
  const int size = size_of_first();
  const auto is_too_small = [&](int core) { return core + 1 < size; };
  cores_.erase(std::find_if(cores_.begin(), cores_.end(), is_too_small), cores_.end());
  names_.resize(cores_.size());
  graph_ = InducedSubgraphs(graph)(names_);
  missing_ = MissingEdges(graph_);
  all_.resize(names_.size());
  std::iota(all_.begin(), all_.end(), 0);
}

double MaxCliqueSearch::memory(int nodes) {
  // Peeling, lists, the graph in another order, that of the candidates, a level for each node of a clique, and in large graphs
  // a block of edges.
  return 500.0 * nodes + InducedSubgraphs::memory(nodes) + CommonNeighbors::memory(nodes) +
         (nodes < kNodesOfLarge ? 0 : EdgeSupport::memory(nodes)) + 2 * MissingEdges::memory(nodes) +
         2.5 * BitGraph::memory(nodes) + 4096;
}

int MaxCliqueSearch::size_of_first() const {
  if (names_.empty()) return 0;
  int size = 1;
  std::vector<Word> common(whole_.neighbors(names_[0]), whole_.neighbors(names_[0]) + whole_.words());
  for (const int node : names_) {
    if (!(common[static_cast<std::size_t>(node >> 6)] >> (node & 63) & 1)) continue;
    ++size;
    for (std::size_t word = 0; word < common.size(); ++word) common[word] &= whole_.neighbors(node)[word];
  }
  return size;
}

std::optional<Indices> MaxCliqueSearch::find_one(std::int64_t max_steps) {
  Indices best;
  double words = 0;
  for (int node = 0; node < graph_.size() && words < kMostGrown; ++node) {
    if (cores_[static_cast<std::size_t>(node)] < static_cast<int>(best.size())) break;
    Indices grown = grow_from(node, best.size());
    words += static_cast<double>(grown.size()) * graph_.words();
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

/// Of the neighbours of all nodes so far the first, which has the largest core number. Nothing where that is no more than so many.
Indices MaxCliqueSearch::grow_from(int node, std::size_t beaten) const {
  std::vector<Word> common(graph_.neighbors(node), graph_.neighbors(node) + graph_.words());
  if (missing_.are_listed()) {
    for (std::size_t word = 0; word < common.size(); ++word)
      for (Word rest = common[word] & missing_.with_some()[word]; rest != 0; rest &= common[word] & (rest - 1)) {
        const int next = 64 * static_cast<int>(word) + lowest(rest);
        for (const int* other = missing_.begin(next); other != missing_.end(next); ++other)
          common[static_cast<std::size_t>(*other >> 6)] &= ~(Word{1} << (*other & 63));
      }
    if (static_cast<std::size_t>(count_bits(common)) + 1 <= beaten) return {};
    Indices clique{node};
    BitGraph::for_bits(common.data(), graph_.words(), [&](int next) { clique.push_back(next); });
    return clique;
  }
  Indices clique{node};
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
  steps_ = 0, max_steps_ = max_steps, work_ = 0;
  const bool is_large = graph_.size() >= kNodesOfLarge && !missing_.are_listed();
  clique_.clear();
  InducedSubgraphs induced(graph_);
  Coloring of_graph(graph_, missing_);
  EdgeSupport support(graph_);
  for (node_ = 0; node_ < graph_.size(); ++node_) {
    if (cores_[static_cast<std::size_t>(node_)] + 1 < needed_) break;  // so are all that follow
    if (is_large && node_ % BitGraph::kNodesOfBlock == 0) remove_thin_edges(node_, support);
    candidates_ = candidates_of(node_);
    if (static_cast<int>(candidates_.size()) + 1 < needed_) continue;
    if (++steps_ > max_steps_ || work_ / work_per_step_ > max_steps_) return false;
    if (candidates_.empty()) {
      found_();
      continue;
    }
    if (levels_.empty()) levels_.emplace_back();
    if (2 * static_cast<int>(candidates_.size()) > graph_.size()) {  // a graph of the candidates would be no smaller
      set_candidates(graph_);
      candidates_ = all_;
      if (!expand(graph_, of_graph)) return false;
      continue;
    }
    const BitGraph subgraph = induced(candidates_);
    work_ += static_cast<std::int64_t>(candidates_.size()) * graph_.words() * kWorkPerWord;
    const MissingEdges missing(subgraph);
    Coloring coloring(subgraph, missing);
    levels_[0].candidates.assign(static_cast<std::size_t>(subgraph.words()), ~Word{0});
    if (subgraph.size() % 64 != 0) levels_[0].candidates.back() = (Word{1} << subgraph.size() % 64) - 1;
    if (!expand(subgraph, coloring)) return false;
  }
  return true;
}

void MaxCliqueSearch::set_candidates(const BitGraph& graph) {
  std::vector<Word>& words = levels_[0].candidates;
  words.assign(static_cast<std::size_t>(graph.words()), 0);
  for (const int node : candidates_) words[static_cast<std::size_t>(node >> 6)] |= Word{1} << (node & 63);
}

Indices MaxCliqueSearch::later_neighbors(int node) const {
  Indices later;
  BitGraph::for_bits(graph_.neighbors(node), (node + 63) / 64, [&](int other) {
    if (other < node) later.push_back(other);
  });
  return later;
}

/// Whether neighbours in common with others are counted one by one.
bool MaxCliqueSearch::is_sparse(int node, const Indices& others) const {
  const int name = names_[static_cast<std::size_t>(node)];
  return !common_.is_faster(name, 0, whole_.words(), static_cast<int>(others.size()));
}

/// Removes edges between the nodes of a block that begins with this one and nodes removed later: those in too few triangles for a
/// clique of one node less than needed, where candidates_of() would count common neighbours one by one.
void MaxCliqueSearch::remove_thin_edges(int node, EdgeSupport& support) {
  Indices nodes;
  const int end = std::min(node + BitGraph::kNodesOfBlock, graph_.size());
  for (; node < end && cores_[static_cast<std::size_t>(node)] + 1 >= needed_; ++node) {
    const Indices later = later_neighbors(node);
    if (static_cast<int>(later.size()) + 1 >= needed_ && is_sparse(node, later)) nodes.push_back(node);
  }
  support.remove_below(needed_ - 3, nodes);
}

/// The neighbours removed later that have enough neighbours in common with the node.
Indices MaxCliqueSearch::candidates_of(int node) {
  if (node + 1 < needed_) return {};
  const Indices later = later_neighbors(node);
  Indices kept;
  if (static_cast<int>(later.size()) + 1 < needed_) return {};
  const int name = names_[static_cast<std::size_t>(node)];
  const auto keep = [&](int other, int common) {
    if (common + 2 >= needed_) kept.push_back(other);
  };
  if (!is_sparse(node, later)) {
    const std::vector<int>& common = common_.count(name, 0, whole_.words());
    for (const int other : later)
      keep(other, common[static_cast<std::size_t>(names_[static_cast<std::size_t>(other)])]);
    return kept;
  }
  Indices common(later.size()), named;
  for (const int other : later) named.push_back(names_[static_cast<std::size_t>(other)]);
  whole_.count_common(name, named, common.data());
  for (std::size_t k = 0; k < later.size(); ++k) keep(later[k], common[k]);
  return kept;
}

/// Depth first, without recursion: a clique may have more nodes than the stack has room for.
bool MaxCliqueSearch::expand(const BitGraph& graph, Coloring& coloring) {
  std::size_t depth = 0;
  bool is_new = true;
  for (;;) {
    if (levels_.size() == depth + 1) levels_.emplace_back();
    Level& level = levels_[depth];
    const int size = static_cast<int>(clique_.size()) + 1;  // with the node itself
    if (is_new) {
      const std::int64_t before = coloring.work();
      const int colors = coloring(level.candidates, needed_ - size, level.order, level.colors),
                count = count_bits(level.candidates);
      work_ += coloring.work() - before;
      if (colors == count && size + count >= needed_) {
        if (!take_all(level.candidates)) return false;
        level.order.clear();
      }
      is_new = false;
    }
    if (level.order.empty() || size + level.colors[level.order.size() - 1] < needed_) {
      if (depth-- == 0) return true;
      clique_.pop_back();
      levels_[depth].remove_last();
      continue;
    }
    if (++steps_ > max_steps_ || work_ / work_per_step_ > max_steps_) return false;
    const int next = level.order.back();
    std::vector<Word>& common = levels_[depth + 1].candidates;
    common.resize(level.candidates.size());
    Word any = 0;
    for (std::size_t word = 0; word < common.size(); ++word)
      any |= common[word] = level.candidates[word] & graph.neighbors(next)[word];
    clique_.push_back(next);
    if (any != 0) {
      ++depth;
      is_new = true;
      continue;
    }
    if (size + 1 >= needed_) found_();
    clique_.pop_back();
    level.remove_last();
  }
}

void MaxCliqueSearch::Level::remove_last() {
  candidates[static_cast<std::size_t>(order.back() >> 6)] &= ~(Word{1} << (order.back() & 63));
  order.pop_back();
}

/// Every candidate has a colour of its own: it is a neighbour of all before it. The steps are those of one after the other.
bool MaxCliqueSearch::take_all(const std::vector<Word>& candidates) {
  const std::size_t before = clique_.size();
  BitGraph::for_bits(candidates.data(), static_cast<int>(candidates.size()),
                     [&](int node) { clique_.push_back(node); });
  steps_ += static_cast<std::int64_t>(clique_.size() - before);
  if (steps_ > max_steps_) return false;
  found_();
  clique_.resize(before);
  return true;
}

Indices MaxCliqueSearch::names_of(const Indices& nodes) const {
  Indices names;
  for (const int node : nodes) names.push_back(names_[static_cast<std::size_t>(node)]);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace corral
