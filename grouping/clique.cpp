// SPDX-License-Identifier: MIT
#include "grouping/clique.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "grouping/columns/canonical_order.h"
#include "grouping/columns/compatibility.h"
#include "grouping/graph/core_numbers.h"
#include "grouping/graph/max_clique.h"
#include "grouping/pose/gnc.h"
#include "grouping/pose/pose_choice.h"
#include "kernel/weighted_fit.h"

namespace corral {
namespace {

bool share_point(const Points& points, int a, int b) { return (points.row(a).array() == points.row(b).array()).all(); }

/// Rows of a table in canonical order, where copies stand behind each other, without the copies.
Indices rows_without_copies(const CorrespondenceSet& matches) {
  Indices rows;
  for (int row = 0; row < matches.size(); ++row)
    if (rows.empty() || !share_point(matches.source_points, rows.back(), row) ||
        !share_point(matches.target_points, rows.back(), row))
      rows.push_back(row);
  return rows;
}

void disconnect_shared(const Points& points, BitGraph& graph) {
  Indices order(static_cast<std::size_t>(graph.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    for (int axis = 0; axis < 3; ++axis)
      if (points(a, axis) != points(b, axis)) return points(a, axis) < points(b, axis);
    return false;
  });
  for (auto first = order.begin(); first != order.end(); ++first)
    for (auto other = first + 1; other != order.end() && share_point(points, *first, *other); ++other)
      graph.disconnect(*first, *other);
}

constexpr int kStepsPerComparison = 10;  // the comparison of equals may take a tenth of the steps of the search

class Grouping {
 public:
  Grouping(const CorrespondenceSet& matches, const CliqueOptions& options)
      : matches_(matches), options_(options), edge_(options.edge_pr * matches.resolution) {}

  GroupingResult run() {
    Indices rows =
        options_.distinct ? rows_without_copies(matches_) : Indices(static_cast<std::size_t>(matches_.size()));
    if (!options_.distinct) std::iota(rows.begin(), rows.end(), 0);
    Indices structure = find_structure(select_rows(matches_, rows));
    for (int& row : structure) row = rows[static_cast<std::size_t>(row)];
    GroupingResult result = fit(structure);
    result.notes = std::move(notes_);
    return result;
  }

 private:
  Indices find_structure(const CorrespondenceSet& matches) {
    BitGraph graph = consistency_graph(matches, edge_);
    if (options_.distinct)
      for (const Points* points : {&matches.source_points, &matches.target_points}) disconnect_shared(*points, graph);
    if (options_.structure == DenseStructure::Core) return largest_core(graph);
    MaxCliqueSearch search(graph);
    const auto first = search.find_one(options_.max_steps);
    notes_.push_back({"steps", search.steps()});
    if (!first) {
      notes_.push_back({"core_instead", 1});
      return largest_core(graph);
    }
    return first->size() < 3 ? Indices() : tightest(matches, search, *first);
  }

  static Indices largest_core(const BitGraph& graph) {
    CoreNumbers cores = core_numbers(graph);  // numbers never fall in the order of removal
    const auto is_smaller = [&](int node) {
      return cores.numbers[static_cast<std::size_t>(node)] <
             cores.numbers[static_cast<std::size_t>(cores.order.back())];
    };
    cores.order.erase(std::remove_if(cores.order.begin(), cores.order.end(), is_smaller), cores.order.end());
    std::sort(cores.order.begin(), cores.order.end());
    return cores.order;
  }

  /// Of all cliques as large as `first` that whose distances differ least; of equals the first in the order of lists.
  Indices tightest(const CorrespondenceSet& matches, MaxCliqueSearch& search, const Indices& first) {
    Indices best = first;
    std::optional<double> smallest;  // of the best, once it is compared
    std::int64_t cliques = 0;
    const bool is_complete = search.visit_all(static_cast<int>(first.size()), options_.max_steps / kStepsPerComparison,
                                              [&](const Indices& clique) {
                                                ++cliques;
                                                if (clique == best) return;
                                                if (!smallest) smallest = sum_of_differences(matches, best);
                                                const double sum = sum_of_differences(matches, clique);
                                                if (sum < *smallest || (sum == *smallest && clique < best))
                                                  best = clique, smallest = sum;
                                              });
    notes_.push_back({"equal_cliques", cliques});
    if (!is_complete) notes_.push_back({"comparison_left", 1});
    return best;
  }

  static double sum_of_differences(const CorrespondenceSet& matches, const Indices& clique) {
    double sum = 0;
    for (std::size_t a = 0; a < clique.size(); ++a)
      for (std::size_t b = a + 1; b < clique.size(); ++b) {
        const PairDistances lengths = pair_distances(matches, clique[a], clique[b]);
        sum += std::abs(lengths.source - lengths.target);
      }
    return sum;
  }

  GroupingResult fit(const Indices& structure) const {
    const std::vector<double> ones(structure.size(), 1.0);
    const auto pose = options_.refit == StructureFit::Gnc ? fit_gnc(matches_, structure, edge_)
                                                          : fit_weighted(matches_, structure, ones);
    PoseRule rule;
    rule.tolerance_pr = options_.tolerance_pr;
    PoseChoice choice(matches_, rule);
    if (pose) choice.offer(*pose);
    return choice.finish();
  }

  const CorrespondenceSet& matches_;
  const CliqueOptions& options_;
  const double edge_;
  std::vector<Note> notes_;
};

}  // namespace

GroupingResult group_by_clique(const CorrespondenceSet& matches, const CliqueOptions& options) {
  validate_options(options, "clique");
  matches.validate();
  return group_in_canonical_order(matches,
                                  [&](const CorrespondenceSet& sorted) { return Grouping(sorted, options).run(); });
}

double working_memory(int matches, const CliqueOptions& options) {
  const bool searches = options.structure == DenseStructure::Clique;
  return 2 * canonical_order_memory(matches) + BitGraph::memory(matches) + 440.0 * matches +
         (searches ? MaxCliqueSearch::memory(matches) : 0) + PoseChoice::memory(matches, 1, {});
}

}  // namespace corral
