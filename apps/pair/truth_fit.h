// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/runtime/json.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/coincidence.h"
#include "kernel/surface/search/resolution.h"

namespace corral {

/// Whether a truth can belong to the surfaces of its pair.
struct TruthFit {
  enum Verdict {
    Fits,
    Loose,       ///< the surfaces lie 1 to 2 pr apart, as those of real scanners may
    Inverted,    ///< the inverse fits, or with its translation times `factor`
    OtherUnits,  ///< it fits with its translation times `factor`
    Transposed,  ///< it fits with its rotation transposed
    Misplaced,   ///< nothing of this fits: another pair's truth, or surfaces that do not overlap
  };
  Verdict verdict = Fits;
  double factor = 1;
  Coincidence given;     ///< of the surfaces under the truth
  Coincidence mended{};  ///< of what fits instead

  bool belongs() const { return verdict == Fits || verdict == Loose; }

  /// The verdict with its numbers, for a message; empty if the truth fits.
  std::string text() const;

  /// "fits", "loose", "inverted", "translation times 0.001", "inverted, translation times 0.001", "transposed" or
  /// "misplaced".
  std::string name() const;
  static bool is_belonging(const std::string& name) { return name == "fits" || name == "loose"; }
};

/// Looks at up to 3,000 vertices of the coarser surface. `surface_from_points`: the truth, or its inverse if the points are
/// the target's; the verdict is the same. `resolution`: mesh units per pr of the pair.
///
/// A truth belongs to the pair if at least 2 % of the points lie within 2 pr of the surface, and more of them than after a
/// small turn (distinctness of at least 1.05), or most of all. It does not if something else fits much better.
TruthFit fit_truth(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                   const RigidTransform& surface_from_points, double resolution);

/// The same from the meshes, with the pr of each that lone vertices do not move; builds the tree of the finer one.
TruthFit fit_truth(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                   const PointSpacing& source_spacing, const PointSpacing& target_spacing);

/// Whether it belongs, the name, the share within 2 pr and the median, as given and of what fits instead, and the text.
Json to_json(const TruthFit& fit);

}  // namespace corral
