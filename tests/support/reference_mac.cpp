// SPDX-License-Identifier: MIT
#include "tests/support/reference_mac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "kernel/weighted_fit.h"
#include "tests/support/reference_pose_choice.h"

namespace corral::reference {
namespace {

Eigen::MatrixXd weights_of(const CorrespondenceSet& matches, double gate) {
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = 0; j < matches.size(); ++j) {
      const double d = pair_lengths(matches, i, j).difference / matches.resolution;
      const double compatibility = std::exp(-d * d / 200);
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
        if (w(i, a) > 0 && w(i, b) > 0) ++count, sum += std::cbrt(w(i, a) * w(i, b) * w(a, b));
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

/// Every maximal clique, from lists of candidates and of nodes that were tried before.
void list_cliques(const Eigen::MatrixXd& w, const Indices& clique, Indices candidates, Indices tried,
                  const std::function<void(const Indices&)>& visit) {
  if (candidates.empty() && tried.empty()) return visit(clique);
  if (candidates.empty()) return;
  const auto count = [&](int node) {
    return std::count_if(candidates.begin(), candidates.end(), [&](int other) { return w(node, other) > 0; });
  };
  Indices both = candidates;
  both.insert(both.end(), tried.begin(), tried.end());
  const int pivot = *std::max_element(both.begin(), both.end(), [&](int a, int b) { return count(a) < count(b); });
  for (const int node : Indices(candidates)) {
    if (w(pivot, node) > 0) continue;
    Indices longer = clique, fewer, fewer_tried;
    longer.push_back(node);
    std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(fewer),
                 [&](int k) { return w(node, k) > 0; });
    std::copy_if(tried.begin(), tried.end(), std::back_inserter(fewer_tried), [&](int k) { return w(node, k) > 0; });
    list_cliques(w, longer, fewer, fewer_tried, visit);
    candidates.erase(std::find(candidates.begin(), candidates.end(), node));
    tried.push_back(node);
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
  list_cliques(w, {}, thinned(w), {}, [&](Indices clique) {
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

}  // namespace corral::reference
