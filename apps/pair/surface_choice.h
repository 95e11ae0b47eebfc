// SPDX-License-Identifier: MIT
#pragma once

#include "apps/pair/evaluate_pair.h"
#include "grouping/grouper.h"
#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/surface_coverage.h"

namespace corral {

/// Poses that groupers return beside the chosen one where surfaces choose, unless the user says otherwise.
constexpr int kPosesForSurfaces = 50;

/// Chooses among the poses that a grouper considered by how the surfaces lie on each other: outside the grouper, which sees no
/// surface.
class SurfaceChoice {
 public:
  SurfaceChoice(const Mesh& source, const Mesh& target, const ParallelFor& parallel = one_by_one);

  /// The grouper's own pose and its runners-up are each refined twice: over the rows within 5 pr, and over all rows, where a
  /// weak pose slides to a stronger one near by. If the pose under which the surfaces cover each other best within 4 pr is
  /// not the grouper's own over its rows, it replaces that, and the rows within 5 pr of it replace the selection. Without
  /// runners-up the answer stays as it is.
  GroupingResult operator()(const CorrespondenceSet& matches, const GroupingResult& found) const;

 private:
  SurfaceCoverage coverage_;
};

/// Replaces what every grouper found by this choice, scored, refined and judged anew. Times are of the grouping alone.
void choose_by_surfaces(std::vector<MethodRecord>& records, const SurfaceChoice& choose,
                        const CorrespondenceSet& matches, const std::optional<PairTruth>& truth);

/// The options of a grouper with the poses that the choice needs: kPosesForSurfaces, if it can keep poses and is not told how
/// many.
OptionOverrides with_kept_poses(const std::string& grouper, OptionOverrides options);

}  // namespace corral
