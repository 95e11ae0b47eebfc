// SPDX-License-Identifier: MIT
#include "apps/pair/surface_choice.h"

#include "apps/pair/confidence_signals.h"
#include "kernel/surface/normals.h"
#include "refine/refine_rigid.h"

namespace corral {
namespace {

constexpr double kReachPr = 4;
constexpr std::size_t kFewestRows = 3;

SurfaceCoverage coverage_of(const Mesh& source, const Mesh& target, const ParallelFor& parallel) {
  const Points source_normals = estimate_normals(source, {}, parallel),
               target_normals = estimate_normals(target, {}, parallel);
  return {{source.vertices, source_normals}, {target.vertices, target_normals}};
}

}  // namespace

SurfaceChoice::SurfaceChoice(const Mesh& source, const Mesh& target, const ParallelFor& parallel)
    : coverage_(coverage_of(source, target, parallel)) {}

GroupingResult SurfaceChoice::operator()(const CorrespondenceSet& matches, const GroupingResult& found) const {
  if (!found.target_from_source || found.runner_up.empty()) return found;
  std::vector<RigidTransform> starts = {*found.target_from_source};
  for (const ScoredPose& pose : found.runner_up) starts.push_back(pose.target_from_source);
  ScoredPose best;
  bool is_own = true;
  const auto consider = [&](const RefinedPose& refined, const RigidTransform& start, bool is_of_selection) {
    const RigidTransform pose = refined.target_from_source.value_or(start);
    const double score = coverage_(pose, kReachPr * matches.resolution);
    if (score > best.score) best = {pose, score}, is_own = is_of_selection;
  };
  for (std::size_t i = 0; i < starts.size(); ++i) {
    consider(refine_rigid(matches, agreeing_rows(matches, starts[i]), {}, starts[i]), starts[i], i == 0);
    consider(refine_over_all(matches, starts[i]), starts[i], false);
  }
  GroupingResult chosen = found;
  if (is_own) return chosen;
  chosen.selected = agreeing_rows(matches, best.target_from_source);
  if (chosen.selected.size() < kFewestRows) return found;
  chosen.target_from_source = best.target_from_source;
  return chosen;
}

void choose_by_surfaces(std::vector<MethodRecord>& records, const SurfaceChoice& choose,
                        const CorrespondenceSet& matches, const std::optional<PairTruth>& truth) {
  for (MethodRecord& record : records) {
    if (!record.failure.empty() || record.found.runner_up.empty()) continue;
    record.found = choose(matches, record.found);
    judge(record, matches, truth);
  }
}

OptionOverrides with_kept_poses(const std::string& grouper, OptionOverrides options) {
  const Grouper* entry = look_up(groupers(), grouper);
  if (!entry) return options;
  for (const OptionValue& option : entry->options)
    if (option.name == "keep") options.try_emplace("keep", std::to_string(kPosesForSurfaces));
  return options;
}

}  // namespace corral
