// SPDX-License-Identifier: MIT
#include "apps/pair/register_pair.h"

#include <algorithm>
#include <utility>

#include "apps/pair/surface_choice.h"
#include "grouping/registry.h"
#include "kernel/missing_column.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/scan/depth_image.h"
#include "kernel/surface/search/nearest_points.h"
#include "refine/refine_rigid.h"
#include "refine/refine_surface.h"

namespace corral {
namespace {

constexpr double kReachPr = 4, kSamePr = 1, kApartPr = 5;
constexpr double kCellPr = 2, kInFrontPr = 5, kMostInFront = 0.015;  // as in the alignment of many views
constexpr int kAskedAtFirst = 1500;
constexpr double kMostBytes = 4e9;
constexpr std::size_t kRefinedOnSurfaces = 8;

/// The surfaces, prepared for many poses.
class Surfaces {
 public:
  Surfaces(const RegisteredSurfaces& given, double resolution, const ParallelFor& parallel)
      : given_(given),
        resolution_(resolution),
        source_normals_(estimate_normals(given.source, {}, parallel)),
        target_normals_(estimate_normals(given.target, {}, parallel)),
        tree_(given.target.vertices, parallel),
        rough_({given.source.vertices, source_normals_}, {given.target.vertices, target_normals_}, kAskedAtFirst),
        fine_({given.source.vertices, source_normals_}, {given.target.vertices, target_normals_}) {
    if (given.source_sensor) seen_by_source_.emplace(given.source.vertices, kCellPr * resolution, *given.source_sensor);
    if (given.target_sensor) seen_by_target_.emplace(given.target.vertices, kCellPr * resolution, *given.target_sensor);
  }

  double rough(const RigidTransform& pose) const { return rough_(pose, kReachPr * resolution_); }
  double fine(const RigidTransform& pose) const { return fine_(pose, kReachPr * resolution_); }

  RefinedSurface refine(const RigidTransform& start) const {
    NearestTracker tracker(tree_);
    return refine_surface(
        {{given_.source.vertices, source_normals_},
         {given_.target.vertices, target_normals_},
         resolution_,
         [&](const Points& queries, double limit) -> const PointPairs& { return tracker.pair(queries, limit); }},
        start);
  }

  double share_in_front(const RigidTransform& pose) const {
    const double margin = kInFrontPr * resolution_;
    double share = 0;
    if (seen_by_target_) share = seen_by_target_->share_in_front(pose.apply(given_.source.vertices), margin);
    if (seen_by_source_)
      share = std::max(share, seen_by_source_->share_in_front(pose.inverse().apply(given_.target.vertices), margin));
    return share;
  }

 private:
  const RegisteredSurfaces& given_;
  double resolution_;
  Points source_normals_, target_normals_;
  PointTree tree_;
  SurfaceCoverage rough_, fine_;
  std::optional<DepthImage> seen_by_source_, seen_by_target_;
};

class PairRegistration {
 public:
  PairRegistration(const CorrespondenceSet& matches, const std::optional<RegisteredSurfaces>& surfaces,
                   const ParallelFor& parallel, const RegistrationObserver& observer)
      : matches_(matches), parallel_(parallel), observer_(observer) {
    if (surfaces) surfaces_.emplace(*surfaces, matches.resolution, parallel);
  }

  Registration run() {
    propose();
    begin("refining the poses over the matches");
    refine_over_matches();
    if (surfaces_) {
      begin("refining the best on the surfaces");
      refine_on_surfaces();
    }
    if (result_.poses.empty()) return std::move(result_);
    for (const ProposedPose& pose : surfaces_ ? all_poses_ : result_.poses)
      result_.others.all.push_back(pose.target_from_source);
    const ProposedPose& best = result_.poses.front();
    result_.signals = confidence_signals(matches_, best.target_from_source, result_.others, best.surfaces);
    return std::move(result_);
  }

 private:
  void begin(const std::string& step) const {
    if (observer_) observer_(step);
  }

  /// The groupers' poses, then their runners-up; those that have none beside them by the fit to their selection.
  void propose() {
    for (const Proposer& proposer : proposers()) {
      begin(proposer.method);
      const auto found = corral::propose(proposer, matches_);
      if (!found) continue;
      result_.methods.push_back(proposer.method);
      ++result_.others.groupers;
      if (!found->target_from_source) continue;
      result_.others.own.push_back(*found->target_from_source);
      add_start(proposer.method, *found->target_from_source);
      for (const ScoredPose& pose : found->runner_up) add_start(proposer.method, pose.target_from_source);
    }
  }

  void add_start(const std::string& method, const RigidTransform& pose) {
    const bool is_known = std::any_of(starts_.begin(), starts_.end(), [&](const ProposedPose& other) {
      return pose_distance_pr(matches_, pose, other.target_from_source) < kSamePr;
    });
    if (!is_known) starts_.push_back({method, pose, 0, 0, {}});
  }

  /// Over the rows within 5 pr, and over all, where a weak pose slides to a stronger one: the better of both.
  void refine_over_matches() {
    parallel_(static_cast<int>(starts_.size()), [&](int i) {
      ProposedPose& start = starts_[static_cast<std::size_t>(i)];
      const RigidTransform before = start.target_from_source;
      start.score = -1;
      for (const RefinedPose& refined :
           {refine_rigid(matches_, agreeing_rows(matches_, before), {}, before), refine_over_all(matches_, before)}) {
        const RigidTransform pose = refined.target_from_source.value_or(before);
        const double score = surfaces_ ? surfaces_->rough(pose) : table_score(matches_, pose);
        if (score > start.score) start.score = score, start.target_from_source = pose;
      }
    });
    keep_best(starts_.size());
  }

  /// Sorted, and of those that are near each other the best.
  void keep_best(std::size_t most) {
    std::stable_sort(starts_.begin(), starts_.end(),
                     [](const ProposedPose& one, const ProposedPose& other) { return one.score > other.score; });
    result_.poses.clear();
    for (ProposedPose& start : starts_) {
      if (result_.poses.size() == most) break;
      const bool is_near = std::any_of(result_.poses.begin(), result_.poses.end(), [&](const ProposedPose& better) {
        return pose_distance_pr(matches_, start.target_from_source, better.target_from_source) < kApartPr;
      });
      if (is_near) continue;
      start.support = static_cast<int>(agreeing_rows(matches_, start.target_from_source).size());
      result_.poses.push_back(start);
    }
  }

  void refine_on_surfaces() {
    starts_ = result_.poses;
    if (starts_.size() > kRefinedOnSurfaces) starts_.resize(kRefinedOnSurfaces);
    parallel_(static_cast<int>(starts_.size()), [&](int i) {
      ProposedPose& start = starts_[static_cast<std::size_t>(i)];
      const RefinedSurface refined = surfaces_->refine(start.target_from_source);
      start.score = surfaces_->fine(start.target_from_source);
      start.surfaces.overlap = refined.before.overlap, start.surfaces.rms_pr = refined.before.rms_pr;
      if (refined.target_from_source) {
        const double score = surfaces_->fine(*refined.target_from_source);
        if (score > start.score) {
          start.surfaces.moved_pr = pose_distance_pr(matches_, start.target_from_source, *refined.target_from_source);
          start.target_from_source = *refined.target_from_source;
          start.score = score;
        }
        start.surfaces.overlap = refined.after.overlap, start.surfaces.rms_pr = refined.after.rms_pr;
      }
      start.surfaces.in_front = surfaces_->share_in_front(start.target_from_source);
    });
    const auto is_contradicted = [](const ProposedPose& pose) { return pose.surfaces.in_front > kMostInFront; };
    if (!std::all_of(starts_.begin(), starts_.end(), is_contradicted))
      starts_.erase(std::remove_if(starts_.begin(), starts_.end(), is_contradicted), starts_.end());
    all_poses_ = result_.poses;
    keep_best(starts_.size());
  }

  const CorrespondenceSet& matches_;
  const ParallelFor& parallel_;
  const RegistrationObserver& observer_;
  std::optional<Surfaces> surfaces_;
  std::vector<ProposedPose> starts_, all_poses_;
  Registration result_;
};

}  // namespace

const std::vector<Proposer>& proposers() {
  static const std::vector<Proposer> table = [] {
    std::vector<Proposer> all = {{"gc", {}},
                                 {"tcf", {}},
                                 {"ransac", {{"iterations", "50000"}}},
                                 {"hough", {}},
                                 {"frame-ransac", {{"score", "mae"}}},
                                 {"turboreg", {{"score", "mae"}, {"edge_pr", "3"}}},
                                 {"mac", {}},
                                 {"sc2pcr", {}}};
    for (Proposer& each : all) each.options = with_kept_poses(each.method, each.options);
    return all;
  }();
  return table;
}

double proposers_memory(int matches) {
  double most = 0;
  for (const Proposer& proposer : proposers()) {
    const double needed = find_grouper(proposer.method).configure(proposer.options).working_memory(matches);
    if (needed <= kMostBytes) most = std::max(most, needed);
  }
  return most;
}

std::optional<GroupingResult> propose(const Proposer& proposer, const CorrespondenceSet& matches) {
  const ConfiguredGrouper grouper = find_grouper(proposer.method).configure(proposer.options);
  if (grouper.working_memory(matches.size()) > kMostBytes) return std::nullopt;
  try {
    GroupingResult found = grouper.group(matches);
    if (!found.target_from_source) found.target_from_source = refine_rigid(matches, found.selected).target_from_source;
    return found;
  } catch (const MissingColumn&) {
    return std::nullopt;
  }
}

int registration_steps() { return static_cast<int>(proposers().size()) + 2; }

Registration register_pair(const CorrespondenceSet& matches, const std::optional<RegisteredSurfaces>& surfaces,
                           const ParallelFor& parallel, const RegistrationObserver& observer) {
  return PairRegistration(matches, surfaces, parallel, observer).run();
}

}  // namespace corral
