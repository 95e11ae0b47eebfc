// SPDX-License-Identifier: MIT
#include "grouping/geometric_consistency.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/compatibility.h"

namespace corral {
namespace {

constexpr std::size_t kSmallestClique = 4;

class ConsistencyTest {
 public:
  ConsistencyTest(const CorrespondenceSet& matches, double tolerance)
      : matches_(matches), tolerance_(tolerance), difference_(matches.size()) {}

  bool operator()(int i, int j) const {
    const PairDistances distances = pair_distances(matches_, i, j);
    return std::abs(distances.source - distances.target) < tolerance_;
  }

  /// d(seed, j) for all j at once.
  const Eigen::ArrayXd& differences(int seed) {
    const auto p = matches_.source_points.array();
    const auto q = matches_.target_points.array();
    difference_ =
        (((p.col(0) - p(seed, 0)).square() + (p.col(1) - p(seed, 1)).square() + (p.col(2) - p(seed, 2)).square())
             .sqrt() -
         ((q.col(0) - q(seed, 0)).square() + (q.col(1) - q(seed, 1)).square() + (q.col(2) - q(seed, 2)).square())
             .sqrt())
            .abs();
    return difference_;
  }

  int count(int seed) { return static_cast<int>((differences(seed) < tolerance_).count()); }

 private:
  const CorrespondenceSet& matches_;
  const double tolerance_;
  Eigen::ArrayXd difference_;
};

Indices largest_star(const CorrespondenceSet& matches, double tolerance) {
  ConsistencyTest consistent(matches, tolerance);
  int best_seed = -1, best_count = 0;
  for (int seed = 0; seed < matches.size(); ++seed) {
    const int count = consistent.count(seed);  // the seed agrees with itself: d = 0
    if (count > best_count) best_count = count, best_seed = seed;
  }
  Indices selected;
  if (best_seed < 0) return selected;
  const Eigen::ArrayXd& differences = consistent.differences(best_seed);
  for (int row = 0; row < matches.size(); ++row)
    if (differences(row) < tolerance) selected.push_back(row);
  return selected;
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

}  // namespace corral
