// SPDX-License-Identifier: MIT
#include "grouping/turboreg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/graph/common_neighbors.h"
#include "grouping/pose/pose_choice.h"
#include "kernel/triangle_fit.h"

namespace corral {
namespace {

constexpr double kDegenerateAreaPr2 = 1e-3;
constexpr std::size_t kThirds = 2;  ///< triangles of a pivot

using Triangle = std::array<int, 3>;

double difference_of_lengths(const CorrespondenceSet& matches, int i, int j) {
  const PairDistances lengths = pair_distances(matches, i, j);
  return std::abs(lengths.source - lengths.target);
}

struct Pivot {
  int common;  ///< W
  int i, j;
  double difference;  ///< D
};
bool comes_first(const Pivot& a, const Pivot& b) {
  return std::tie(b.common, a.difference, a.i, a.j) < std::tie(a.common, b.difference, b.i, b.j);
}

struct Third {
  int common;  ///< W_ik + W_jk
  int k;
  double difference;  ///< max(D_ik, D_jk)
};
bool is_better(const Third& a, const Third& b) {
  return std::tie(b.common, a.difference, a.k) < std::tie(a.common, b.difference, b.k);
}

constexpr int kRowsPerSampled = 16, kMostSampled = 512;

/// Rows that are an edge to many others first: by a sample, which decides about nothing but time.
Indices connected_first(const CorrespondenceSet& matches, const TurboregOptions& options) {
  const Indices degrees =
      sampled_degrees(matches, options.edge_pr * matches.resolution, options.min_length_pr * matches.resolution,
                      std::min(matches.size() / kRowsPerSampled, kMostSampled));
  Indices rows(degrees.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) {
    return degrees[static_cast<std::size_t>(a)] > degrees[static_cast<std::size_t>(b)];
  });
  return rows;
}

constexpr double kEdgesPerRow = 16;  ///< of all rows, so many edges are counted together at least

/// Room for the first edges and for candidates.
std::size_t pivots_held(double rows, int pivots) {
  return static_cast<std::size_t>(std::min(2.0 * pivots, rows * (rows - 1) / 2));
}

class Triangles {
 public:
  Triangles(const CorrespondenceSet& matches, const TurboregOptions& options)
      : names_(connected_first(matches, options)),
        matches_(select_rows(matches, names_)),
        graph_(consistency_graph(matches_, options.edge_pr * matches.resolution,
                                 options.min_length_pr * matches.resolution)),
        common_(graph_) {
    find_pivots(static_cast<std::size_t>(options.pivots));
    add_triangles();
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }

  /// Of rows of the table, ascending.
  const std::vector<Triangle>& operator()() const { return found_; }

 private:
  /// The first `count` edges, in any order. An edge has fewer common neighbours than either of its nodes has neighbours: where
  /// nodes of high degree stand in front, those behind need not be counted once the best are known.
  void find_pivots(std::size_t count) {
    const std::size_t held = pivots_held(matches_.size(), static_cast<int>(count));
    pivots_.reserve(held);
    std::vector<BitGraph::Word> found;
    std::vector<int> counts_of_block;
    int fewest = 1, end = graph_.size();  // with less an edge is not among the first; no node from `end` on has more
    const auto offer = [&](int i, int j, int shared) {
      if (shared < fewest) return;
      const bool in_order = name(i) < name(j);
      pivots_.push_back({shared, in_order ? i : j, in_order ? j : i, difference_of_lengths(matches_, i, j)});
      if (pivots_.size() == held && held > count) fewest = keep_first(count);
    };
    for (int i = 0; i < end;) {
      BitGraph::NodeBlock block{i / 64, std::min(i / 64 + BitGraph::kBlock, graph_.words()), {}, {}};
      block.nodes.assign(BitGraph::kBlock, 0);
      double most_edges = 0;
      for (; i < std::min(64 * block.last, end) && most_edges < kEdgesPerRow * graph_.size(); ++i) {
        while (end > i && common_.degree(end - 1) <= fewest) --end;
        if (common_.degree(i) <= fewest) continue;
        const int first = i / 64, last = (end + 63) / 64;
        if (!common_.is_faster(i, first, last, graph_.degree(i, first, last))) {
          block.nodes[static_cast<std::size_t>(first - block.first)] |= BitGraph::Word{1} << (i & 63);
          most_edges += common_.degree(i);
          continue;
        }
        const std::vector<int>& counts = common_.count(i, first, last);
        common_.find(fewest, found);
        found[0] &= ~((BitGraph::Word{2} << (i & 63)) - 1);
        for (int word = first; word < last; ++word) {
          const BitGraph::Word edges = found[static_cast<std::size_t>(word - first)] & graph_.neighbors(i)[word];
          BitGraph::for_bits(&edges, 1, [&](int bit) {
            offer(i, 64 * word + bit, counts[static_cast<std::size_t>(64 * (word - first) + bit)]);
          });
        }
      }
      for (int j = 0; j < end; ++j) block.wanted.push_back(common_.degree(j) > fewest);
      const BitGraph::BlockEdges edges(graph_, block, BitGraph::Others::Behind);
      graph_.count_common(edges, fewest, counts_of_block);
      auto shared = counts_of_block.begin();
      edges.for_each([&](int a, int b) { offer(a, b, *shared++); });
    }
    if (pivots_.size() > count) keep_first(count);
    found_.reserve(kThirds * pivots_.size());
  }

  int keep_first(std::size_t count) {
    const auto last = pivots_.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(pivots_.begin(), last, pivots_.end(),
                     [&](const Pivot& a, const Pivot& b) { return comes_first(named(a), named(b)); });
    pivots_.resize(count);
    return pivots_.back().common;
  }
  Pivot named(const Pivot& pivot) const { return {pivot.common, name(pivot.i), name(pivot.j), pivot.difference}; }

  /// One node after the other, so that its common neighbours with all others are counted once.
  void add_triangles() {
    const auto by_nodes = [](const Pivot& a, const Pivot& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); };
    std::sort(pivots_.begin(), pivots_.end(), by_nodes);
    std::vector<int> of_node;
    int node = -1;
    for (const Pivot& pivot : pivots_) {
      if (pivot.i != node) of_node = common_.count(node = pivot.i, 0, graph_.words());
      add_triangles_on(pivot, of_node);
    }
  }

  /// `of_node` counts the common neighbours of its first node and all others.
  void add_triangles_on(const Pivot& pivot, const std::vector<int>& of_node) {
    const std::vector<int>& of_other = common_.count(pivot.j, 0, graph_.words());
    const BitGraph::Word *a = graph_.neighbors(pivot.i), *b = graph_.neighbors(pivot.j);
    std::array<Third, kThirds + 1> best;  // and one that goes
    std::size_t held = 0;
    for (int word = 0; word < graph_.words(); ++word) {
      const BitGraph::Word both = a[word] & b[word];
      BitGraph::for_bits(&both, 1, [&](int bit) {
        const int k = 64 * word + bit;
        const int common = of_node[static_cast<std::size_t>(k)] + of_other[static_cast<std::size_t>(k)];
        if (held == kThirds && common < best[kThirds - 1].common) return;
        const double difference =
            std::max(difference_of_lengths(matches_, pivot.i, k), difference_of_lengths(matches_, pivot.j, k));
        best[held] = {common, name(k), difference};
        for (std::size_t place = held; place > 0 && is_better(best[place], best[place - 1]); --place)
          std::swap(best[place], best[place - 1]);
        held = std::min(held + 1, kThirds);
      });
    }
    for (std::size_t n = 0; n < held; ++n) {
      Triangle corners{name(pivot.i), name(pivot.j), best[n].k};
      std::sort(corners.begin(), corners.end());
      found_.push_back(corners);
    }
  }

  int name(int node) const { return names_[static_cast<std::size_t>(node)]; }

  const Indices names_;  ///< rows of the caller's table
  const CorrespondenceSet matches_;
  const BitGraph graph_;
  CommonNeighbors common_;
  std::vector<Pivot> pivots_;  ///< i and j are nodes, that of the smaller name first
  std::vector<Triangle> found_;
};

void offer_poses(const CorrespondenceSet& matches, const std::vector<Triangle>& triangles, PoseChoice& choice) {
  LaneTriangles source, target;
  LaneMotions motions;
  for (std::size_t first = 0; first < triangles.size(); first += kLanes) {
    const std::size_t used = std::min<std::size_t>(kLanes, triangles.size() - first);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {  // those left over repeat the last one
      const Triangle& corners = triangles[first + std::min(lane, used - 1)];
      source.set(static_cast<int>(lane), matches.source_points, corners);
      target.set(static_cast<int>(lane), matches.target_points, corners);
    }
    fit_triangles(source, target, kDegenerateAreaPr2 * matches.resolution * matches.resolution, motions);
    for (int lane = 0; lane < static_cast<int>(used); ++lane)
      if (motions.is_usable(lane)) choice.offer(motions.get(lane));
  }
}

PoseRule rule_of(const TurboregOptions& options) {
  return {options.score, options.tolerance_pr, options.refit_rounds, options.keep};
}

}  // namespace

GroupingResult group_by_turboreg(const CorrespondenceSet& matches, const TurboregOptions& options) {
  validate_options(options, "turboreg");
  matches.validate();
  if (matches.size() < 3) return {};
  return group_in_canonical_order(matches, [&](const CorrespondenceSet& rows) {
    PoseChoice choice(rows, rule_of(options));
    offer_poses(rows, Triangles(rows, options)(), choice);
    return choice.finish();
  });
}

double working_memory(int matches, const TurboregOptions& options) {
  const double pivots = static_cast<double>(pivots_held(matches, options.pivots));
  // Names, sampled degrees and two lists of counts; strips of the graph while it is made, then counts of neighbours.
  return 2 * canonical_order_memory(matches) + BitGraph::memory(matches) + CommonNeighbors::memory(matches) +
         80.0 * matches + BitGraph::memory_of_block(matches, (kEdgesPerRow + 1) * matches) + pivots * sizeof(Pivot) +
         std::min(pivots, 1.0 * options.pivots) * kThirds * sizeof(Triangle) +
         PoseChoice::memory(matches, std::min(pivots, 1.0 * options.pivots) * kThirds, rule_of(options));
}

}  // namespace corral
