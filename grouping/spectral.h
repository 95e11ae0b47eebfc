// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

struct SpectralOptions {
  double similarity = 0.6;
  bool once = false;
  bool weighted = false;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(
        OptionField{"similarity", "", "0.6", "rigidity ratio from which two matches are compatible", above_up_to(0, 1)},
        self.similarity);
    visit(OptionField{"once", "", "false", "one eigenvector of the whole graph instead of one per accepted match"},
          self.once);
    visit(OptionField{"weighted", "", "", "edges weigh their rigidity ratio instead of 1"}, self.weighted);
  }
};

/// Spectral technique (ST): greedy choice by the principal eigenvector of the graph of compatible matches.
///
///   M_ij = [ r(i,j) >= similarity ],  M_ii = 1
///   repeat   x = principal eigenvector of M over the remaining matches;  accept i = argmax x;
///            remove i and every j with r(i,j) < similarity
///   until    no match remains, or max x <= 1e-9
///
/// once      x is computed for the full graph only.      weighted   M_ij = r(i,j) where r(i,j) >= similarity.
/// Source    [leordeanu2005spectral]; form and value [yang2017evaluation], Table 1.
/// Reads     source_points, target_points.
/// Returns   selected only.
/// Cost      O(M^2) time for the graph, for all matches that leave, and for each matrix product, of which there are far fewer
///           than accepted matches (see leading_entry.h). M^2 / 8 bytes for the graph, 1.5 * 2^30 at most: what is not stored
///           is computed again (compatibility_graph.h); twice that where a part of it is solved on its own. weighted: 8 M^2,
///           twice. Deterministic.
/// Throws    InvalidInput: option out of range, ragged or non-finite columns.
/// Departs   The eigenvector is the converged one (see principal_eigenvector.h), not that of a fixed number of rounds; it is
///           computed until it is certain which entry is the largest. Entries within 1e-9 of the maximum are ties: the lowest
///           row wins. Conflict means incompatible (the paper leaves it open). Two parts with equal eigenvalues: the one with
///           the lowest row first. No compatible pair: nothing is selected.
GroupingResult group_by_spectral(const CorrespondenceSet& matches, const SpectralOptions& options = {});
double working_memory(int matches, const SpectralOptions& options);

}  // namespace corral
