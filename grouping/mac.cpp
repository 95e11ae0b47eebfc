// SPDX-License-Identifier: MIT
#include "grouping/mac.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/columns/otsu.h"
#include "grouping/graph/edge_weights.h"
#include "grouping/graph/induced_subgraph.h"
#include "grouping/graph/maximal_cliques.h"
#include "grouping/pose/pose_choice.h"
#include "kernel/elementary.h"
#include "kernel/weighted_fit.h"

namespace corral {
namespace {

constexpr double kAlphaPr = 10;
constexpr int kSmallestClique = 3;
constexpr double kCrowded = 3;        // coefficients above which only the best nodes remain,
constexpr std::ptrdiff_t kLeft = 50;  // about so many

/// The difference of distances at which the compatibility falls to the gate.
double edge_pr(double gate) { return kAlphaPr * std::sqrt(-2 * logarithm(gate)); }

PoseRule rule_of(const MacOptions& options) {
  return {options.score, options.tolerance_pr, options.refit_rounds, options.keep};
}

struct WeighedClique {
  double weight = 0;
  Indices nodes;  ///< ascending
};

bool is_heavier(const WeighedClique& a, const WeighedClique& b) {
  if (a.weight != b.weight) return a.weight > b.weight;
  if (a.nodes.size() != b.nodes.size()) return a.nodes.size() > b.nodes.size();
  return a.nodes < b.nodes;
}

/// The heaviest cliques through each node; others are forgotten.
class HeaviestCliques {
 public:
  HeaviestCliques(int nodes, int per_node)
      : per_node_(static_cast<std::size_t>(per_node)), named_(static_cast<std::size_t>(nodes)) {}

  /// Whether a clique of this weight may be among them.
  bool are_reached(double weight, const Indices& nodes) const {
    return std::any_of(nodes.begin(), nodes.end(), [&](int node) {
      const Indices& named = named_[static_cast<std::size_t>(node)];
      return named.size() < per_node_ || weight >= at(named.back()).weight;
    });
  }

  void offer(const WeighedClique& clique) {
    int place = -1;
    for (const int node : clique.nodes) {
      Indices& named = named_[static_cast<std::size_t>(node)];
      if (named.size() == per_node_ && !is_heavier(clique, at(named.back()))) continue;
      if (place < 0) place = store(clique);
      const auto before =
          std::find_if(named.begin(), named.end(), [&](int other) { return is_heavier(clique, at(other)); });
      named.insert(before, place);
      ++uses_[static_cast<std::size_t>(place)];
      if (named.size() <= per_node_) continue;
      if (--uses_[static_cast<std::size_t>(named.back())] == 0) free_.push_back(named.back());
      named.pop_back();
    }
  }

  /// The heaviest first.
  std::vector<WeighedClique> all() const {
    std::vector<WeighedClique> cliques;
    for (std::size_t place = 0; place < cliques_.size(); ++place)
      if (uses_[place] > 0) cliques.push_back(cliques_[place]);
    std::sort(cliques.begin(), cliques.end(), is_heavier);
    return cliques;
  }

 private:
  const WeighedClique& at(int place) const { return cliques_[static_cast<std::size_t>(place)]; }

  int store(const WeighedClique& clique) {
    if (free_.empty()) {
      free_.push_back(static_cast<int>(cliques_.size()));
      cliques_.emplace_back(), uses_.push_back(0);
    }
    const int place = free_.back();
    free_.pop_back();
    cliques_[static_cast<std::size_t>(place)] = clique;
    return place;
  }

  const std::size_t per_node_;
  std::vector<Indices> named_;  ///< places of the cliques of a node, the heaviest first
  std::vector<WeighedClique> cliques_;
  Indices uses_, free_;
};

/// The weights of cliques one after the other: what two that follow begin with is not added up again.
class CliqueWeigher {
 public:
  explicit CliqueWeigher(const EdgeWeights& weights)
      : weights_(weights), is_member_(static_cast<std::size_t>(weights.size())) {}

  double operator()(const Indices& clique) {
    const auto common = std::mismatch(clique_.begin(), clique_.end(), clique.begin(), clique.end()).first;
    for (auto node = common; node != clique_.end(); ++node) is_member_[static_cast<std::size_t>(*node)] = 0;
    sums_.resize(static_cast<std::size_t>(common - clique_.begin()));
    clique_.resize(sums_.size());
    while (clique_.size() < clique.size()) {
      const int node = clique[clique_.size()];
      sums_.push_back((sums_.empty() ? 0 : sums_.back()) + weights_.sum_of_products(node, is_member_));
      is_member_[static_cast<std::size_t>(node)] = 1;
      clique_.push_back(node);
    }
    return sums_.back();
  }

 private:
  const EdgeWeights& weights_;
  std::vector<double> is_member_, sums_;  ///< 0 or 1 for each node; of the first nodes of the clique
  Indices clique_;
};

class Grouping {
 public:
  Grouping(const CorrespondenceSet& matches, const MacOptions& options)
      : matches_(matches),
        options_(options),
        graph_(consistency_graph(matches, edge_pr(options.gate) * matches.resolution)),
        weights_(graph_) {}

  GroupingResult run() {
    measure();
    const std::vector<WeighedClique> cliques = find_cliques(well_connected_nodes());
    PoseChoice choice(matches_, rule_of(options_));
    for (const WeighedClique& clique : cliques)
      if (const auto pose = fit_weighted(matches_, clique.nodes, std::vector<double>(clique.nodes.size(), 1.0)))
        choice.offer(*pose);
    GroupingResult result = choice.finish();
    notes_.push_back({"hypotheses", static_cast<std::int64_t>(cliques.size())});
    result.notes = std::move(notes_);
    return result;
  }

 private:
  /// W and c.
  void measure() {
    const double alpha = kAlphaPr * matches_.resolution;
    weights_.replace_each([&](int i, int j, double) {
      const PairDistances lengths = pair_distances(matches_, i, j);
      const double d = (lengths.source - lengths.target) / alpha;
      return exponential(-d * d / 2);
    });
    PathSums paths(weights_);
    weigh(paths);
    measure_connectedness(paths);
  }

  /// W on the edges of G; those of weight 0 leave the graph.
  void weigh(PathSums& paths) {
    paths.visit([](double weight) { return weight; },
                [&](const PathSums::PathSum& path) {
                  weights_.set(path.there, path.sum), weights_.set(path.back, path.sum);
                  if (!(path.sum > 0)) graph_.disconnect(path.node, path.other);
                });
  }

  /// c: the sum over the pairs of neighbours, which the sum of paths counts twice, by their number.
  void measure_connectedness(PathSums& paths) {
    std::vector<double> sums(static_cast<std::size_t>(graph_.size()));
    paths.visit(cube_root, [&](const PathSums::PathSum& path) {  // to each node in the order of its neighbours
      sums[static_cast<std::size_t>(path.node)] += path.sum / 2;
      sums[static_cast<std::size_t>(path.other)] += path.sum / 2;
    });
    double all_sums = 0, all_pairs = 0;
    for (int i = 0; i < graph_.size(); ++i) {
      const double sum = sums[static_cast<std::size_t>(i)];
      const double degree = graph_.degree(i), pairs = degree * (degree - 1) / 2;
      connectedness_.push_back(degree < 2 ? 0 : sum / pairs);
      all_sums += sum, all_pairs += pairs;
    }
    total_ = all_pairs > 0 ? all_sums / all_pairs : 0;
  }

  double c(int node) const { return connectedness_[static_cast<std::size_t>(node)]; }

  Indices well_connected_nodes() const {
    Indices nodes(connectedness_.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    if (static_cast<std::ptrdiff_t>(nodes.size()) <= kLeft) return nodes;
    const double otsu = otsu_bins100_threshold(connectedness_);
    const double mean =
        std::accumulate(connectedness_.begin(), connectedness_.end(), 0.0) / static_cast<double>(nodes.size());
    if (!(std::min({otsu, mean, total_}) > kCrowded)) return nodes;
    std::vector<double> sorted = connectedness_;
    std::nth_element(sorted.begin(), sorted.begin() + kLeft - 1, sorted.end(), std::greater<>());
    double limit = 0;
    for (int twentieths = 200; twentieths > 0 && limit == 0; --twentieths) {
      const double product = twentieths / 20.0 * std::max(otsu, total_);
      if (product <= sorted[static_cast<std::size_t>(kLeft - 1)]) limit = product;
    }
    nodes.erase(std::remove_if(nodes.begin(), nodes.end(), [&](int node) { return !(c(node) > limit); }), nodes.end());
    return nodes;
  }

  std::vector<WeighedClique> find_cliques(Indices nodes) {
    InducedSubgraphs induced(graph_);
    for (std::int64_t halvings = 0;; ++halvings) {
      HeaviestCliques heaviest(graph_.size(), options_.cliques_per_node);
      CliqueWeigher weigh(weights_);
      std::int64_t cliques = 0;
      const auto steps =
          visit_maximal_cliques(induced(nodes), kSmallestClique, options_.max_steps, [&](const Indices& clique) {
            ++cliques;
            WeighedClique weighed{0, clique};
            for (int& node : weighed.nodes) node = nodes[static_cast<std::size_t>(node)];
            weighed.weight = weigh(weighed.nodes);
            if (!heaviest.are_reached(weighed.weight, weighed.nodes)) return;
            std::sort(weighed.nodes.begin(), weighed.nodes.end());
            heaviest.offer(weighed);
          });
      if (!steps) {
        halve(nodes);
        continue;
      }
      notes_ = {{"steps", *steps}, {"cliques", cliques}};
      if (halvings > 0) notes_.push_back({"halvings", halvings});
      return heaviest.all();
    }
  }

  void halve(Indices& nodes) const {
    std::stable_sort(nodes.begin(), nodes.end(), [&](int a, int b) { return c(a) > c(b); });
    nodes.resize(nodes.size() / 2);
    std::sort(nodes.begin(), nodes.end());
  }

  const CorrespondenceSet& matches_;
  const MacOptions& options_;
  BitGraph graph_;
  EdgeWeights weights_;
  std::vector<double> connectedness_;
  double total_ = 0;
  std::vector<Note> notes_;
};

}  // namespace

GroupingResult group_by_mac(const CorrespondenceSet& matches, const MacOptions& options) {
  validate_options(options, "mac");
  matches.validate();
  return group_in_canonical_order(matches,
                                  [&](const CorrespondenceSet& sorted) { return Grouping(sorted, options).run(); });
}

double working_memory(int matches, const MacOptions& options) {
  const double pairs = 1.0 * matches * matches, hypotheses = 1.0 * options.cliques_per_node * matches;
  // The weights of edges; then those behind c, or the cliques that matches name.
  const double later =
      std::max(PathSums::memory(matches, pairs) + 16.0 * matches, 4 * options.cliques_per_node * pairs);
  return canonical_order_memory(matches) + BitGraph::memory(matches) + EdgeWeights::memory(matches, pairs) + later +
         maximal_cliques_memory(matches) + 100 * hypotheses + PoseChoice::memory(matches, hypotheses, rule_of(options));
}

}  // namespace corral
