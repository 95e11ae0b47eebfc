// SPDX-License-Identifier: MIT
#include "grouping/clique.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

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

/// The sums of | |p_i - p_j| - |p'_i - p'_j| | over the pairs of two sets of rows, compared.
class Tightness {
 public:
  /// No difference is `largest` or more.
  Tightness(const CorrespondenceSet& matches, double largest) : matches_(matches), largest_(largest) {}

  /// Whether the sum of one set, added up in its order, is smaller than that of the other; of equal sums the set that comes first. Sets
  /// that have most of their rows in common are told apart by the others, if that is certain.
  bool is_first(const Indices& rows, const Indices& others) {
    Indices shared, only, only_other;
    std::set_intersection(rows.begin(), rows.end(), others.begin(), others.end(), std::back_inserter(shared));
    std::set_difference(rows.begin(), rows.end(), shared.begin(), shared.end(), std::back_inserter(only));
    std::set_difference(others.begin(), others.end(), shared.begin(), shared.end(), std::back_inserter(only_other));
    if (kFewDiffer * (only.size() + only_other.size()) < shared.size()) {
      const double sum = sum_with(only, shared), other = sum_with(only_other, shared);
      if (std::abs(sum - other) > error(rows.size()) + error(others.size())) return sum < other;
    }
    if (others != last_) last_sum_ = add_up(last_ = others, others.size());
    const double sum = add_up(rows, rows.size());
    if (!(sum < last_sum_ || (sum == last_sum_ && rows < others))) return false;
    last_ = rows, last_sum_ = sum;
    return true;
  }

 private:
  static constexpr std::size_t kFewDiffer = 8;

  /// How far sums over the pairs of so many rows may be off: each addition by 2^-53 of the sum.
  double error(std::size_t rows) const {
    const double pairs = 0.5 * static_cast<double>(rows) * static_cast<double>(rows);
    return 0x1p-52 * pairs * pairs * largest_;
  }

  /// Over the pairs that `rows` are in, with each other and with the others.
  double sum_with(const Indices& rows, const Indices& others) {
    Indices all = rows;
    all.insert(all.end(), others.begin(), others.end());
    return add_up(all, rows.size());
  }

  /// Over the pairs of each of the first rows and those behind it.
  double add_up(const Indices& rows, std::size_t firsts) {
    CorrespondenceSet table;  // of points alone
    table.source_points = matches_.source_points(rows, Eigen::all);
    table.target_points = matches_.target_points(rows, Eigen::all);
    double sum = 0;
    for (int a = 0; a < static_cast<int>(firsts); ++a) {
      differences_.resize(rows.size());
      for (int b = a + 1; b < table.size(); ++b) {  // apart from the sum: several at once
        const PairDistances lengths = pair_distances(table, a, b);
        differences_[static_cast<std::size_t>(b)] = std::abs(lengths.source - lengths.target);
      }
      for (std::size_t b = static_cast<std::size_t>(a) + 1; b < rows.size(); ++b) sum += differences_[b];
    }
    return sum;
  }

  const CorrespondenceSet& matches_;
  const double largest_;
  Indices last_;  ///< added up before
  double last_sum_ = 0;
  std::vector<double> differences_;
};

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
    Tightness tightness(matches, edge_);
    std::int64_t cliques = 0;
    const bool is_complete = search.visit_all(static_cast<int>(first.size()), options_.max_steps / kStepsPerComparison,
                                              [&](const Indices& clique) {
                                                ++cliques;
                                                if (clique != best && tightness.is_first(clique, best)) best = clique;
                                              });
    notes_.push_back({"equal_cliques", cliques});
    if (!is_complete) notes_.push_back({"comparison_left", 1});
    return best;
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
