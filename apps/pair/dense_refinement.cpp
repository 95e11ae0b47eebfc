// SPDX-License-Identifier: MIT
#include "apps/pair/dense_refinement.h"

#include <utility>

#include "kernel/surface/normals.h"

namespace corral {

DenseRefinement::DenseRefinement(const Mesh& source, const Mesh& target, double resolution, ParallelFor parallel)
    : source_(source),
      target_(target),
      resolution_(resolution),
      parallel_(std::move(parallel)),
      source_normals_(estimate_normals(source, {}, parallel_)),
      target_normals_(estimate_normals(target, {}, parallel_)),
      tree_(target.vertices, parallel_),
      tracker_(tree_, parallel_) {}

void DenseRefinement::refine(std::vector<MethodRecord>& records, const std::optional<PairTruth>& truth) {
  const SurfacePair surfaces{
      {source_.vertices, source_normals_},
      {target_.vertices, target_normals_},
      resolution_,
      [this](const Points& queries, double limit) -> const PointPairs& { return tracker_.pair(queries, limit); },
      parallel_};
  for (MethodRecord& record : records) {
    if (!record.pose.target_from_source) continue;
    record.dense = refine_surface(surfaces, *record.pose.target_from_source);
    if (truth && record.dense->target_from_source)
      record.dense_errors = pose_errors(*record.dense->target_from_source, *truth, resolution_);
  }
}

}  // namespace corral
