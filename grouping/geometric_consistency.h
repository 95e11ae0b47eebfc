// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// What a cluster is.
enum class ClusterRule {
  Star,    ///< one seed and all that agree with the seed
  Clique,  ///< grown greedily in order of feature distance; each new member agrees with all before it
};
constexpr std::array<const char*, 2> choice_names(ClusterRule) { return {"star", "clique"}; }

struct GeometricConsistencyOptions {
  double tolerance_pr = 3;
  ClusterRule cluster = ClusterRule::Star;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"tolerance_pr", "pr", "3", "difference of distances below which two matches agree", above(0)},
          self.tolerance_pr);
    visit(OptionField{"cluster", "", "star", "agreement with the seed (star) or with every member (clique)"},
          self.cluster);
  }
};

/// Geometric consistency (GC): the largest set of matches that agree with one seed match on both surfaces.
///
///   d(i,j) = | |p_i - p_j| - |p'_i - p'_j| |     C_i = {i} + { j : d(i,j) < tolerance }     selected = argmax_i |C_i|
///
/// clique    Seeds in ascending order of feature distance (ties: lower row), each unless it is in a cluster already; a seed
///           collects, in the same order over all free matches, those that agree with all collected so far. Clusters of
///           more than 3 are kept, the members of others stay free; the largest is selected, the first among equals.
/// Source    [chen2007consistency]; form and value [yang2017evaluation], Table 1.
/// Reads     source_points, target_points, resolution; feature_distance only for the clique.
/// Returns   selected only.
/// Cost      O(M^2) time, O(M) memory. Deterministic.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns, feature_distance absent for the clique.
/// Departs   Ties go to the smaller seed row (the paper does not say). The clique has no RANSAC behind it.
GroupingResult group_by_geometric_consistency(const CorrespondenceSet& matches,
                                              const GeometricConsistencyOptions& options = {});
double working_memory(int matches, const GeometricConsistencyOptions& options);

}  // namespace corral
