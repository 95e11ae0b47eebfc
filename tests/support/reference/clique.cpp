// SPDX-License-Identifier: MIT
#include "tests/support/reference/clique.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tests/support/reference/weighted_fit.h"

namespace corral::reference {
namespace {

double length(const Points& points, int i, int j) {
  const double x = points(i, 0) - points(j, 0), y = points(i, 1) - points(j, 1), z = points(i, 2) - points(j, 2);
  return std::sqrt(x * x + y * y + z * z);
}

double difference(const CorrespondenceSet& matches, int i, int j) {
  return std::abs(length(matches.source_points, i, j) - length(matches.target_points, i, j));
}

std::array<double, 6> key(const CorrespondenceSet& matches, int i) {
  const Points &p = matches.source_points, &q = matches.target_points;
  return {p(i, 0), p(i, 1), p(i, 2), q(i, 0), q(i, 1), q(i, 2)};
}

bool have_equal_points(const CorrespondenceSet& matches, int i, int j) {
  return matches.source_points.row(i) == matches.source_points.row(j) ||
         matches.target_points.row(i) == matches.target_points.row(j);
}

/// The rows by their points; with `distinct` one of each.
Indices ordered_rows(const CorrespondenceSet& matches, bool distinct) {
  Indices rows;
  for (int i = 0; i < matches.size(); ++i) rows.push_back(i);
  std::stable_sort(rows.begin(), rows.end(), [&](int i, int j) { return key(matches, i) < key(matches, j); });
  const auto is_copy = [&](int i, int j) { return key(matches, i) == key(matches, j); };
  if (distinct) rows.erase(std::unique(rows.begin(), rows.end(), is_copy), rows.end());
  return rows;
}

using Graph = std::vector<std::vector<char>>;

Graph graph_of(const CorrespondenceSet& matches, const Indices& rows, const CliqueOptions& options) {
  Graph graph(rows.size(), std::vector<char>(rows.size(), 0));
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t b = 0; b < rows.size(); ++b)
      graph[a][b] = a != b && difference(matches, rows[a], rows[b]) < options.edge_pr * matches.resolution &&
                    !(options.distinct && have_equal_points(matches, rows[a], rows[b]));
  return graph;
}

/// Every clique of the largest size.
class Search {
 public:
  explicit Search(const Graph& graph) : graph_(graph) {
    std::vector<std::size_t> all;
    for (std::size_t node = 0; node < graph.size(); ++node) all.push_back(node);
    extend({}, all);
  }
  const std::vector<std::vector<std::size_t>>& largest() const { return largest_; }

 private:
  using Nodes = std::vector<std::size_t>;

  /// Classes of nodes without an edge between them: a clique has one node of each at the most.
  std::vector<Nodes> classes_of(const Nodes& nodes) const {
    std::vector<Nodes> classes;
    for (const std::size_t node : nodes) {
      const auto fits = std::find_if(classes.begin(), classes.end(), [&](const Nodes& members) {
        return std::none_of(members.begin(), members.end(), [&](std::size_t other) { return graph_[node][other]; });
      });
      if (fits == classes.end())
        classes.push_back({node});
      else
        fits->push_back(node);
    }
    return classes;
  }

  std::size_t best() const { return largest_.empty() ? 0 : largest_.front().size(); }

  void extend(const Nodes& clique, Nodes candidates) {
    if (candidates.empty() && !clique.empty() && clique.size() >= best()) {
      if (clique.size() > best()) largest_.clear();
      largest_.push_back(clique);
    }
    const std::vector<Nodes> classes = classes_of(candidates);
    for (std::size_t count = classes.size(); count > 0 && clique.size() + count >= best(); --count)
      for (const std::size_t node : classes[count - 1]) {
        Nodes longer = clique, common;
        longer.push_back(node);
        for (const std::size_t other : candidates)
          if (graph_[node][other]) common.push_back(other);
        candidates.erase(std::find(candidates.begin(), candidates.end(), node));
        extend(longer, common);
      }
  }

  const Graph& graph_;
  std::vector<std::vector<std::size_t>> largest_;
};

Indices tightest_clique(const CorrespondenceSet& matches, const Indices& rows, const Graph& graph) {
  std::vector<std::vector<std::size_t>> largest = Search(graph).largest();
  for (auto& clique : largest) std::sort(clique.begin(), clique.end());
  std::sort(largest.begin(), largest.end());
  Indices best;
  double smallest = 0;
  for (const auto& clique : largest) {
    double sum = 0;
    for (std::size_t a = 0; a < clique.size(); ++a)
      for (std::size_t b = a + 1; b < clique.size(); ++b) sum += difference(matches, rows[clique[a]], rows[clique[b]]);
    if (!best.empty() && !(sum < smallest)) continue;
    smallest = sum;
    best.clear();
    for (const std::size_t node : clique) best.push_back(rows[node]);
  }
  return best;
}

/// Removes what has fewer than k neighbours left until nothing is left; what was left before is the core.
Indices largest_core(const Indices& rows, const Graph& graph) {
  std::vector<std::size_t> core, left;
  for (std::size_t node = 0; node < rows.size(); ++node) left.push_back(node);
  for (std::ptrdiff_t k = 0; !left.empty(); ++k) {
    core = left;
    for (std::size_t before = 0; before != left.size();) {
      before = left.size();
      const std::vector<std::size_t> all = left;
      left.erase(std::remove_if(left.begin(), left.end(),
                                [&](std::size_t node) {
                                  return std::count_if(all.begin(), all.end(),
                                                       [&](std::size_t other) { return graph[node][other]; }) <= k;
                                }),
                 left.end());
    }
  }
  Indices found;
  for (const std::size_t node : core) found.push_back(rows[node]);
  return found;
}

std::optional<Pose> fit_gradually(const CorrespondenceSet& matches, const Indices& rows, double c) {
  auto pose = fit(matches, rows, std::vector<double>(rows.size(), 1.0));
  if (!pose) return pose;
  double largest = 0, last_cost = -1;
  for (const int row : rows) largest = std::max(largest, residual(matches, row, *pose));
  double mu = 1 / (2 * largest * largest / (c * c) - 1);
  if (!(mu > 0) || std::isinf(mu)) return pose;
  for (int round = 0; round < 100; ++round, mu *= 1.4) {
    std::vector<double> weights;
    double cost = 0;
    for (const int row : rows) {
      const double e = residual(matches, row, *pose);
      const double w = e * e >= c * c * (mu + 1) / mu   ? 0
                       : e * e <= c * c * mu / (mu + 1) ? 1
                                                        : c / e * std::sqrt(mu * (mu + 1)) - mu;
      weights.push_back(w);
      cost += w * e * e;
    }
    const auto next = fit(matches, rows, weights);
    if (!next) return pose;
    pose = next;
    const bool decided = std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0 || w == 1; });
    if (decided || (last_cost >= 0 && std::abs(cost - last_cost) < 1e-6 * c * c)) return pose;
    last_cost = cost;
  }
  return pose;
}

}  // namespace

Selection clique(const CorrespondenceSet& matches, const CliqueOptions& options) {
  const Indices rows = ordered_rows(matches, options.distinct);
  const Graph graph = graph_of(matches, rows, options);
  const Indices structure =
      options.structure == DenseStructure::Core ? largest_core(rows, graph) : tightest_clique(matches, rows, graph);
  const auto pose = options.refit == StructureFit::Gnc
                        ? fit_gradually(matches, structure, options.edge_pr * matches.resolution)
                        : fit(matches, structure, std::vector<double>(structure.size(), 1.0));
  Indices selected;
  for (int row = 0; pose && row < matches.size(); ++row)
    if (residual(matches, row, *pose) < options.tolerance_pr * matches.resolution) selected.push_back(row);
  return {selected.size() < 3 ? Indices() : selected};
}

}  // namespace corral::reference
