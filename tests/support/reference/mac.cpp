// SPDX-License-Identifier: MIT
#include "tests/support/reference/mac.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <functional>
#include <set>

#include "kernel/elementary.h"
#include "kernel/weighted_fit.h"
#include "tests/support/reference/pose_choice.h"

namespace corral::reference {
namespace {

Eigen::MatrixXd weights_of(const CorrespondenceSet& matches, double gate) {
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = 0; j < matches.size(); ++j) {
      const double d = pair_lengths(matches, i, j).difference / matches.resolution;
      const double compatibility = exponential(-d * d / 200);
      if (i != j && compatibility > gate) g(i, j) = compatibility;
    }
  return g.cwiseProduct(g * g);
}

/// The threshold between the bins 0 .. 99 of equal width that maximises the variance between both sides.
double otsu_threshold(const std::vector<double>& values) {
  const double low = *std::min_element(values.begin(), values.end()),
               high = *std::max_element(values.begin(), values.end());
  if (!(high > low)) return low;
  std::array<double, 100> counts{};
  for (const double value : values)
    ++counts[static_cast<std::size_t>(std::min(99.0, std::floor((value - low) / (high - low) * 100)))];
  double best = 0;
  int cut = 0;
  for (int last = 0; last < 99; ++last) {
    double n1 = 0, n2 = 0, s1 = 0, s2 = 0;
    for (int bin = 0; bin < 100; ++bin) {
      const double n = counts[static_cast<std::size_t>(bin)];
      (bin <= last ? n1 : n2) += n, (bin <= last ? s1 : s2) += n * bin;
    }
    if (n1 == 0 || n2 == 0 || counts[static_cast<std::size_t>(last)] == 0) continue;
    const double variance = n1 * n2 * (s1 / n1 - s2 / n2) * (s1 / n1 - s2 / n2);
    if (variance > best * (1 + 1e-12)) best = variance, cut = last;
  }
  return low + (high - low) / 100 * cut;
}

std::vector<int> thinned(const Eigen::MatrixXd& w) {
  std::vector<int> nodes;
  std::vector<double> c;
  double sums = 0, pairs = 0, mean = 0;
  for (int i = 0; i < w.rows(); ++i) {
    double sum = 0, count = 0;
    for (int a = 0; a < w.rows(); ++a)
      for (int b = 0; b < a; ++b)
        if (w(i, a) > 0 && w(i, b) > 0) ++count, sum += cube_root(w(i, a) * w(i, b) * w(a, b));
    nodes.push_back(i);
    c.push_back(count > 0 ? sum / count : 0);
    sums += sum, pairs += count, mean += c.back() / static_cast<double>(w.rows());
  }
  if (nodes.size() <= 50) return nodes;
  const double otsu = otsu_threshold(c), total = pairs > 0 ? sums / pairs : 0;
  if (!(otsu > 3 && mean > 3 && total > 3)) return nodes;
  std::vector<double> sorted = c;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  int step = 0;
  while (step < 200 && (10 - 0.05 * step) * std::max(otsu, total) > sorted[49]) ++step;
  const double limit = step == 200 ? 0 : (10 - 0.05 * step) * std::max(otsu, total);
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                             [&](int node) { return !(c[static_cast<std::size_t>(node)] > limit); }),
              nodes.end());
  return nodes;
}

using Set = std::bitset<512>;  // rows of the tables that it is asked for

/// Every maximal clique, from the candidates for it and the nodes that were tried before.
void list_cliques(const std::vector<Set>& neighbors, const Indices& clique, Set candidates, Set tried,
                  const std::function<void(const Indices&)>& visit) {
  if (candidates.none() && tried.none()) return visit(clique);
  Set kept;  // of the node of most neighbours among the candidates
  std::size_t most = 0;
  for (std::size_t node = 0; node < neighbors.size(); ++node) {
    const std::size_t count = (candidates & neighbors[node]).count();
    if ((candidates | tried)[node] && count > most) most = count, kept = neighbors[node];
  }
  for (std::size_t node = 0; node < neighbors.size(); ++node) {
    if (!candidates[node] || kept[node]) continue;
    Indices longer = clique;
    longer.push_back(static_cast<int>(node));
    list_cliques(neighbors, longer, candidates & neighbors[node], tried & neighbors[node], visit);
    candidates[node] = false, tried[node] = true;
  }
}

struct Weighed {
  double weight;
  Indices nodes;
  bool operator<(const Weighed& other) const {  // the heavier first
    if (weight != other.weight) return weight > other.weight;
    if (nodes.size() != other.nodes.size()) return nodes.size() > other.nodes.size();
    return nodes < other.nodes;
  }
};

std::set<Weighed> heaviest_cliques(const Eigen::MatrixXd& w, int per_node) {
  std::vector<std::set<Weighed>> best(static_cast<std::size_t>(w.rows()));
  std::vector<Set> neighbors(best.size());
  for (int a = 0; a < w.rows(); ++a)
    for (int b = 0; b < w.rows(); ++b)
      neighbors[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = w(a, b) > 0;
  Set nodes;
  for (const int node : thinned(w)) nodes[static_cast<std::size_t>(node)] = true;
  list_cliques(neighbors, {}, nodes, {}, [&](Indices clique) {
    if (clique.size() < 3) return;
    std::sort(clique.begin(), clique.end());
    double weight = 0;
    for (const int a : clique)
      for (const int b : clique)
        if (a < b) weight += w(a, b);
    for (const int node : clique) {
      auto& of_node = best[static_cast<std::size_t>(node)];
      of_node.insert({weight, clique});
      if (of_node.size() > static_cast<std::size_t>(per_node)) of_node.erase(std::prev(of_node.end()));
    }
  });
  std::set<Weighed> all;
  for (const auto& of_node : best) all.insert(of_node.begin(), of_node.end());
  return all;
}

}  // namespace

Selection mac(const CorrespondenceSet& matches, const MacOptions& options) {
  return in_canonical_order(matches, [&](const CorrespondenceSet& sorted) {
    std::vector<RigidTransform> poses;
    for (const Weighed& clique : heaviest_cliques(weights_of(sorted, options.gate), options.cliques_per_node))
      if (const auto pose = fit_weighted(sorted, clique.nodes, std::vector<double>(clique.nodes.size(), 1.0)))
        poses.push_back(*pose);
    return rows_of_best_pose(sorted, poses, options.score, options.tolerance_pr, options.refit_rounds);
  });
}

int mac_hypotheses(const CorrespondenceSet& matches, const MacOptions& options) {
  return static_cast<int>(heaviest_cliques(weights_of(matches, options.gate), options.cliques_per_node).size());
}

}  // namespace corral::reference
