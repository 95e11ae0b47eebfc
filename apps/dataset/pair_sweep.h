// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "apps/runtime/progress.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/nearest_points.h"
#include "kernel/surface/search/resolution.h"

namespace corral {

/// A mesh of a data set, or why it cannot be used.
struct SweptSurface {
  std::string problem;  ///< empty if the rest can be used
  StoredMesh mesh;
  std::optional<PointTree> tree;
  double resolution = 0;    ///< its own, mesh units per pr
  PointSpacing spacing;     ///< what that is the mean of
  std::size_t content = 0;  ///< the same for the same vertices and triangles
};

struct SweptPair {
  const DatasetPair& pair;
  const SweptSurface &source, &target;  ///< empty, without a problem, if the pair is a table alone
  std::optional<RigidTransform> truth;
  std::string truth_problem;             ///< why the named one cannot be used
  std::vector<std::string> truth_notes;  ///< what its reader has to say

  /// Whether it has surfaces, and they can be used.
  bool is_complete() const { return pair.has_surfaces() && source.problem.empty() && target.problem.empty(); }
};

/// Calls visit(i, pair i) for every pair of the set, on any threads and in any order; each mesh is read once and kept as
/// long as a pair needs it. An error in a file does not stop the sweep.
void sweep_pairs(const Dataset& dataset, const ParallelFor& parallel, Progress& progress,
                 const std::function<void(int, const SweptPair&)>& visit);

/// The text of an IoError without the name of its file at the start.
std::string without_path(const std::string& message, const std::string& path);

/// Mesh units per pr of a pair, by the rule of its set and the resolutions of the two sides.
double pair_resolution(const Dataset& dataset, double source, double target);

}  // namespace corral
