// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "grouping/graph/coloring.h"
#include "grouping/graph/common_neighbors.h"
#include "grouping/graph/edge_support.h"

namespace corral {

/// The largest cliques of a graph by branch and bound.
///
/// For each node in turn the cliques are searched that consist of it and nodes which are removed after it in the order of
/// core_numbers(). Candidates are coloured so that neighbours differ; a branch is left when its clique and the number of
/// colours together do not reach the size that is needed. A first clique is grown greedily from each node, neighbours of the
/// largest core number first. Nodes whose core number is too small for that size never take part; in large graphs neither do edges
/// in too few triangles.
/// Source    [tomita2003efficient] (colouring), [eppstein2010listing] (order), [cohen2008trusses] (triangles).
/// Cost      Exponential in the worst case. A step is one node put into a clique. Steps are bounded, and so is the work of
///           colouring (coloring.h) and of making graphs of candidates, to `work_per_step` for each step allowed: the
///           first bound reached ends a search.
class MaxCliqueSearch {
 public:
  /// `graph` must outlive it.
  explicit MaxCliqueSearch(const BitGraph& graph, std::int64_t work_per_step = 1 << 14);

  /// Bytes for so many nodes, beside the graph.
  static double memory(int nodes);

  /// One of the largest cliques, ascending: the first found. Absent if more than `max_steps` steps are needed.
  std::optional<Indices> find_one(std::int64_t max_steps);

  /// Calls visit(clique) for every clique of this size, which must be the largest; ascending. False if it was left after
  /// `max_steps` steps.
  using Visit = std::function<void(const Indices&)>;
  bool visit_all(int size, std::int64_t max_steps, const Visit& visit);

  std::int64_t steps() const { return steps_; }  ///< of the last call

 private:
  struct Level {
    std::vector<BitGraph::Word> candidates;
    Indices order, colors;  ///< candidates that may lead to the size needed; those done are gone from `order`
    void remove_last();
  };

  int size_of_first() const;
  Indices grow_from(int node, std::size_t beaten) const;
  bool search(std::int64_t max_steps);
  Indices candidates_of(int node);
  Indices later_neighbors(int node) const;
  bool is_sparse(int node, const Indices& others) const;
  void remove_thin_edges(int node, EdgeSupport& support);
  void set_candidates(const BitGraph& graph);
  bool take_all(const std::vector<BitGraph::Word>& candidates);
  bool expand(const BitGraph& graph, Coloring& coloring);
  Indices names_of(const Indices& nodes) const;

  const BitGraph& whole_;
  const std::int64_t work_per_step_;
  CommonNeighbors common_;  ///< of it
  Indices names_;  ///< the nodes of the caller that may take part, the last removed first; here they are 0, 1, ...
  Indices cores_, all_;  ///< of them
  BitGraph graph_;       ///< between them
  MissingEdges missing_;
  std::deque<Level> levels_;
  Indices clique_, candidates_;  ///< those of the present node; the clique holds places among them
  int node_ = 0, needed_ = 0;
  std::int64_t steps_ = 0, max_steps_ = 0, work_ = 0;
  std::function<void()> found_;
};

}  // namespace corral
