// SPDX-License-Identifier: MIT
#include "grouping/turboreg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/graph/bit_graph.h"
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

Indices degrees_of(const BitGraph& graph) {
  Indices degrees;
  degrees.reserve(static_cast<std::size_t>(graph.size()));
  for (int node = 0; node < graph.size(); ++node) degrees.push_back(graph.degree(node));
  return degrees;
}

/// Room for the first edges and for candidates.
std::size_t pivots_held(double rows, int pivots) {
  return static_cast<std::size_t>(std::min(2.0 * pivots, rows * (rows - 1) / 2));
}

class Triangles {
 public:
  Triangles(const CorrespondenceSet& matches, const TurboregOptions& options)
      : matches_(matches),
        graph_(consistency_graph(matches, options.edge_pr * matches.resolution,
                                 options.min_length_pr * matches.resolution)),
        degrees_(degrees_of(graph_)),
        counts_(static_cast<std::size_t>(matches.size())),
        of_node_(counts_.size()) {
    others_.reserve(counts_.size());
    find_pivots(static_cast<std::size_t>(options.pivots));
    add_triangles();
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }

  const std::vector<Triangle>& operator()() const { return found_; }

 private:
  /// The first `count` edges, in any order. Nodes of the highest degree come first: an edge has fewer common neighbours than
  /// either of its nodes has neighbours, so that most edges need not be counted once the best are known.
  void find_pivots(std::size_t count) {
    const std::size_t held = pivots_held(matches_.size(), static_cast<int>(count));
    pivots_.reserve(held);
    const auto is_later = [&](int a, int b) { return std::make_pair(-degree(a), a) > std::make_pair(-degree(b), b); };
    Indices nodes(degrees_.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return is_later(b, a); });
    int fewest = 1;  // with less an edge is not among the first
    for (const int i : nodes) {
      if (degree(i) <= fewest) break;
      others_.clear();
      graph_.for_neighbors(i, [&](int j) {
        if (is_later(j, i) && degree(j) > fewest) others_.push_back(j);
      });
      graph_.count_common(i, others_, counts_.data());
      for (std::size_t k = 0; k < others_.size(); ++k) {
        if (counts_[k] < fewest) continue;
        const auto [first, last] = std::minmax(i, others_[k]);
        pivots_.push_back({counts_[k], first, last, difference_of_lengths(matches_, first, last)});
        if (pivots_.size() == held && held > count) fewest = keep_first(count);
      }
    }
    if (pivots_.size() > count) keep_first(count);
    found_.reserve(kThirds * pivots_.size());
  }

  int keep_first(std::size_t count) {
    const auto last = pivots_.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(pivots_.begin(), last, pivots_.end(), comes_first);
    pivots_.resize(count);
    return pivots_.back().common;
  }

  /// One node after the other, so that its common neighbours with all others are counted once.
  void add_triangles() {
    const auto by_nodes = [](const Pivot& a, const Pivot& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); };
    std::sort(pivots_.begin(), pivots_.end(), by_nodes);
    int node = -1;
    for (const Pivot& pivot : pivots_) {
      if (pivot.i != node) count_common_of(node = pivot.i);
      add_triangles_on(pivot);
    }
  }

  void count_common_of(int node) {
    others_.clear();
    graph_.for_neighbors(node, [&](int j) { others_.push_back(j); });
    graph_.count_common(node, others_, counts_.data());
    for (std::size_t n = 0; n < others_.size(); ++n) of_node_[static_cast<std::size_t>(others_[n])] = counts_[n];
  }

  void add_triangles_on(const Pivot& pivot) {
    others_.clear();
    const BitGraph::Word *a = graph_.neighbors(pivot.i), *b = graph_.neighbors(pivot.j);
    for (int word = 0; word < graph_.words(); ++word) {
      const BitGraph::Word both = a[word] & b[word];
      BitGraph::for_bits(&both, 1, [&](int place) { others_.push_back(64 * word + place); });
    }
    graph_.count_common(pivot.j, others_, counts_.data());
    std::array<Third, kThirds + 1> best;  // and one that goes
    std::size_t held = 0;
    for (std::size_t n = 0; n < others_.size(); ++n) {
      const int k = others_[n], common = of_node_[static_cast<std::size_t>(k)] + counts_[n];
      if (held == kThirds && common < best[kThirds - 1].common) continue;
      const double difference =
          std::max(difference_of_lengths(matches_, pivot.i, k), difference_of_lengths(matches_, pivot.j, k));
      best[held] = {common, k, difference};
      for (std::size_t place = held; place > 0 && is_better(best[place], best[place - 1]); --place)
        std::swap(best[place], best[place - 1]);
      held = std::min(held + 1, kThirds);
    }
    for (std::size_t n = 0; n < held; ++n) {
      Triangle corners{pivot.i, pivot.j, best[n].k};
      std::sort(corners.begin(), corners.end());
      found_.push_back(corners);
    }
  }

  int degree(int node) const { return degrees_[static_cast<std::size_t>(node)]; }

  const CorrespondenceSet& matches_;
  const BitGraph graph_;
  const Indices degrees_;
  Indices others_;
  std::vector<int> counts_;   ///< of common neighbours, with others_
  std::vector<int> of_node_;  ///< of common neighbours of the first node of a pivot and each of its neighbours
  std::vector<Pivot> pivots_;
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
  return canonical_order_memory(matches) + BitGraph::memory(matches) + 24.0 * matches + pivots * sizeof(Pivot) +
         std::min(pivots, 1.0 * options.pivots) * kThirds * sizeof(Triangle) +
         PoseChoice::memory(matches, std::min(pivots, 1.0 * options.pivots) * kThirds, rule_of(options));
}

}  // namespace corral
