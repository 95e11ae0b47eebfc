// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// Which rows of the graph the pose is fitted to.
enum class DenseStructure {
  Clique,  ///< a largest set of rows that all agree with each other
  Core,    ///< the rows of the largest core number
};
constexpr std::array<const char*, 2> choice_names(DenseStructure) { return {"clique", "core"}; }

/// How the pose is fitted to them.
enum class StructureFit {
  Gnc,     ///< fit_gnc() with the bound edge_pr
  Kabsch,  ///< least squares
};
constexpr std::array<const char*, 2> choice_names(StructureFit) { return {"gnc", "kabsch"}; }

struct CliqueOptions {
  double edge_pr = 3;
  bool distinct = true;
  DenseStructure structure = DenseStructure::Clique;
  int max_steps = 1000000;
  StructureFit refit = StructureFit::Gnc;
  double tolerance_pr = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"edge_pr", "pr", "", "difference of distances below which two matches agree", above(0)},
          self.edge_pr);
    visit(OptionField{"distinct", "", "", "no agreement between matches that share a point"}, self.distinct);
    visit(OptionField{"structure", "", "", "largest clique, or the rows of the largest core number (core)"},
          self.structure);
    visit(OptionField{"max_steps", "", "", "nodes put into cliques before the core is used instead", at_least(1)},
          self.max_steps);
    visit(OptionField{"refit", "", "", "pose by graduated non-convexity (gnc) or by least squares"}, self.refit);
    visit(OptionField{"tolerance_pr", "pr", "", "residual below which a match agrees with the pose", above(0)},
          self.tolerance_pr);
  }
};

/// Maximum clique (clique): the largest set of matches that all keep their distances to each other, and a robust pose of it.
///
///   G_ij = [ | |p_i - p_j| - |p'_i - p'_j| | < edge ],  i != j       S = the largest clique of G
///   T = fit_gnc(S)                                                   selected = { i : |T p_i - p'_i| < tolerance }
///
/// Of several largest cliques that with the smallest sum of | |p_i - p_j| - |p'_i - p'_j| | over its pairs; of equals the
/// first in the order of lists of rows in canonical order.
/// distinct  No edge between rows with the same source or the same target point; copies of a row count once.
/// core      S = the rows of the largest core number (core_numbers.h), which holds the clique often but not always.
/// Source    [yang2021teaser] (clique, GNC), [shi2021robin] (core), [lusk2021clipper] (distinct), [lim2025kiss] (core, GNC).
/// Reads     source_points, target_points, resolution; other columns settle ties.
/// Returns   selected, target_from_source; notes: `steps`, `equal_cliques` (largest cliques compared), and, only where a bound
///           was reached, `core_instead` or `comparison_left`. Nothing if S or the selection has fewer than 3 rows.
/// Cost      O(M^2) time and M^2 / 4 bytes; the search is exponential, bounded by max_steps and by the work of colouring
///           (max_clique.h), the comparison of equals by a tenth of both.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   One fit of the pose instead of rotation by differences and translation by components; ties by distances; no
///           clock; past the bound the core instead of a heuristic clique; no sample of large tables.
GroupingResult group_by_clique(const CorrespondenceSet& matches, const CliqueOptions& options = {});
double working_memory(int matches, const CliqueOptions& options);

}  // namespace corral
