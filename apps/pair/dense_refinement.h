// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/pair/evaluate_pair.h"
#include "kernel/parallel.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// Dense refinement of the poses of the groupers on the two meshes. The index of the target is built once. The meshes must
/// outlive this.
class DenseRefinement {
 public:
  /// `resolution`: mesh units per pr.
  DenseRefinement(const Mesh& source, const Mesh& target, double resolution, ParallelFor parallel = one_by_one);

  /// Fills `dense` of every record that has a pose, and with a truth its errors.
  void refine(std::vector<MethodRecord>& records, const std::optional<PairTruth>& truth);

 private:
  const Mesh &source_, &target_;
  double resolution_;
  ParallelFor parallel_;
  Points source_normals_, target_normals_;
  PointTree tree_;
  NearestTracker tracker_;
};

}  // namespace corral
