// SPDX-License-Identifier: MIT
#include "apps/dense_refinement.h"

#include "kernel/surface/normals.h"

namespace corral {

DenseRefinement::DenseRefinement(const Mesh& source, const Mesh& target, double resolution)
    : source_(source),
      target_(target),
      resolution_(resolution),
      normals_(estimate_normals(target)),
      tree_(target.vertices),
      tracker_(tree_) {}

void DenseRefinement::refine(std::vector<MethodRecord>& records, const std::optional<PairTruth>& truth) {
  const SurfacePair surfaces{
      source_.vertices, target_.vertices, normals_, resolution_,
      [this](const Points& queries, double limit) -> const Indices& { return tracker_.nearest(queries, limit); }};
  for (MethodRecord& record : records) {
    if (!record.pose.target_from_source) continue;
    record.dense = refine_surface(surfaces, *record.pose.target_from_source);
    if (truth && record.dense->target_from_source)
      record.dense_errors = pose_errors(*record.dense->target_from_source, *truth, resolution_);
  }
}

}  // namespace corral
