// SPDX-License-Identifier: MIT
#include "grouping/geometric_consistency.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "grouping/columns/column_loops.h"
#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter_loops.h"

namespace corral {
namespace {

constexpr std::size_t kSmallestClique = 4;

class ConsistencyTest {
 public:
  ConsistencyTest(const CorrespondenceSet& matches, double tolerance) : matches_(matches), tolerance_(tolerance) {}

  bool operator()(int i, int j) const {
    const PairDistances distances = pair_distances(matches_, i, j);
    return std::abs(distances.source - distances.target) < tolerance_;
  }

  /// The rows that agree with a seed, which agrees with itself: d = 0.
  Indices star(int seed) const {
    std::vector<std::uint8_t> agrees(static_cast<std::size_t>(matches_.size()));
    compare_with_seed(matches_, seed, tolerance_, agrees.data());
    return marked_rows(agrees);
  }

 private:
  const CorrespondenceSet& matches_;
  const double tolerance_;
};

/// Floats count, for every seed, the matches that possibly agree with it. The largest count is replaced by the exact one
/// until the largest is exact: then no other can be larger, nor as large in an earlier row.
Indices largest_star(const CorrespondenceSet& matches, double tolerance) {
  const ConsistencyFilter filter(FilterTable(matches), tolerance);
  const ConsistencyTest consistent(matches, tolerance);
  Indices counts(static_cast<std::size_t>(filter.padded_rows()));
  count_consistent(filter, counts.data());
  const auto end = counts.begin() + matches.size();
  std::vector<char> is_exact(counts.size(), 0);
  Indices star;
  while (matches.size() > 0) {
    const auto largest = std::max_element(counts.begin(), end);  // the first of them
    const auto seed = static_cast<std::size_t>(largest - counts.begin());
    star = consistent.star(static_cast<int>(seed));
    if (is_exact[seed] || star.size() == static_cast<std::size_t>(*largest)) break;
    *largest = static_cast<int>(star.size());
    is_exact[seed] = 1;
  }
  return star;
}

Indices largest_clique(const CorrespondenceSet& matches, double tolerance) {
  const ConsistencyTest consistent(matches, tolerance);
  Indices order(static_cast<std::size_t>(matches.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return matches.feature_distance(a) < matches.feature_distance(b); });
  std::vector<char> taken(order.size(), 0);
  Indices largest;
  for (const int seed : order) {
    if (taken[static_cast<std::size_t>(seed)]) continue;
    Indices members{seed};
    for (const int row : order) {
      if (row == seed || taken[static_cast<std::size_t>(row)]) continue;
      if (std::all_of(members.begin(), members.end(), [&](int member) { return consistent(member, row); }))
        members.push_back(row);
    }
    if (members.size() < kSmallestClique) continue;
    for (const int row : members) taken[static_cast<std::size_t>(row)] = 1;
    if (members.size() > largest.size()) largest = members;
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

}  // namespace

GroupingResult group_by_geometric_consistency(const CorrespondenceSet& matches,
                                              const GeometricConsistencyOptions& options) {
  validate_options(options, "gc");
  matches.validate();
  const double tolerance = options.tolerance_pr * matches.resolution;
  GroupingResult result;
  if (options.cluster == ClusterRule::Clique) {
    require_columns(matches, "gc", {Column::FeatureDistance});
    result.selected = largest_clique(matches, tolerance);
  } else {
    result.selected = largest_star(matches, tolerance);
  }
  return result;
}

double working_memory(int matches, const GeometricConsistencyOptions& options) {
  const bool is_star = options.cluster == ClusterRule::Star;
  // The order, or the counts, and stars or cliques as they grow.
  return 32.0 * matches + (is_star ? FilterTable::memory(matches) + ConsistencyFilter::memory(matches) : 0);
}

}  // namespace corral
