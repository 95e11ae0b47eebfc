// SPDX-License-Identifier: MIT
#include "apps/pair/register_pair.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "apps/pair/surface_choice.h"
#include "grouping/pose/pose_score.h"
#include "grouping/registry.h"
#include "kernel/missing_column.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/scan/depth_image.h"
#include "kernel/surface/search/nearest_points.h"
#include "refine/refine_rigid.h"
#include "refine/refine_surface.h"

namespace corral {
namespace {

/// Each finds pairs that the others miss.
const std::vector<std::pair<std::string, OptionOverrides>> kProposers = {
    {"turboreg", {{"score", "mae"}, {"edge_pr", "3"}}}, {"mac", {}}, {"frame-ransac", {{"score", "mae"}}},
    {"sc2pcr", {}}, {"tcf", {}}, {"ransac", {{"iterations", "50000"}}}, {"gc", {}}, {"hough", {}}};

constexpr double kTolerancePr = 5, kReachPr = 4, kSamePr = 1, kApartPr = 5, kOtherPr = 10;
constexpr double kCellPr = 2, kInFrontPr = 5, kMostInFront = 0.015;  // as in the alignment of many views
constexpr int kAskedAtFirst = 1500;
constexpr std::size_t kRefinedOnSurfaces = 8;

double displacement_pr(const CorrespondenceSet& matches, const RigidTransform& a, const RigidTransform& b) {
  return (a.apply(matches.source_points) - b.apply(matches.source_points)).rowwise().norm().mean() / matches.resolution;
}

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
    if (!given.sensor) return;
    seen_by_source_.emplace(given.source.vertices, kCellPr * resolution, *given.sensor);
    seen_by_target_.emplace(given.target.vertices, kCellPr * resolution, *given.sensor);
  }

  double rough(const RigidTransform& pose) const { return rough_(pose, kReachPr * resolution_); }
  double fine(const RigidTransform& pose) const { return fine_(pose, kReachPr * resolution_); }

  RefinedSurface refine(const RigidTransform& start) const {
    NearestTracker tracker(tree_);
    return refine_surface({{given_.source.vertices, source_normals_},
                           {given_.target.vertices, target_normals_},
                           resolution_,
                           [&](const Points& queries, double limit) -> const PointPairs& {
                             return tracker.pair(queries, limit);
                           }},
                          start);
  }

  double share_in_front(const RigidTransform& pose) const {
    if (!seen_by_source_) return 0;
    const double margin = kInFrontPr * resolution_;
    return std::max(seen_by_target_->share_in_front(pose.apply(given_.source.vertices), margin),
                    seen_by_source_->share_in_front(pose.inverse().apply(given_.target.vertices), margin));
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
    if (!result_.poses.empty()) result_.signals = signals();
    return std::move(result_);
  }

 private:
  void begin(const std::string& step) const {
    if (observer_) observer_(step);
  }

  std::vector<double> residuals(const RigidTransform& pose) const {
    std::vector<double> found;
    measure_residuals(matches_, pose, found);
    return found;
  }
  Indices within(const RigidTransform& pose) const {
    return rows_within(residuals(pose), kTolerancePr * matches_.resolution);
  }

  /// The groupers' poses, then their runners-up; those that have none beside them by the fit to their selection.
  void propose() {
    for (const auto& [name, overrides] : kProposers) {
      begin(name);
      GroupingResult found;
      try {
        found = find_grouper(name).configure(with_kept_poses(name, overrides)).group(matches_);
      } catch (const MissingColumn&) {
        continue;  // it does not apply to this table
      }
      result_.methods.push_back(name);
      if (!found.target_from_source) found.target_from_source = refine_rigid(matches_, found.selected).target_from_source;
      if (!found.target_from_source) continue;
      own_poses_.push_back(*found.target_from_source);
      add_start(name, *found.target_from_source);
      for (const ScoredPose& pose : found.runner_up) add_start(name, pose.target_from_source);
    }
  }

  void add_start(const std::string& method, const RigidTransform& pose) {
    const bool is_known = std::any_of(starts_.begin(), starts_.end(), [&](const ProposedPose& other) {
      return displacement_pr(matches_, pose, other.target_from_source) < kSamePr;
    });
    if (!is_known) starts_.push_back({method, pose, 0, 0, 0, 0, 0, 0});
  }

  /// Over the rows within 5 pr, and over all, where a weak pose slides to a stronger one: the better of both.
  void refine_over_matches() {
    parallel_(static_cast<int>(starts_.size()), [&](int i) {
      ProposedPose& start = starts_[static_cast<std::size_t>(i)];
      const RigidTransform before = start.target_from_source;
      start.score = -1;
      for (const RefinedPose& refined :
           {refine_rigid(matches_, within(before), {}, before), refine_over_all(matches_, before)}) {
        const RigidTransform pose = refined.target_from_source.value_or(before);
        const double score = surfaces_ ? surfaces_->rough(pose) : table_score(pose);
        if (score > start.score) start.score = score, start.target_from_source = pose;
      }
    });
    keep_best(starts_.size());
  }

  double table_score(const RigidTransform& pose) const {
    double sum = 0;
    const double tolerance = kTolerancePr * matches_.resolution;
    for (const double residual : residuals(pose))
      if (residual < tolerance) sum += 1 - residual * residual / (tolerance * tolerance);
    return matches_.size() > 0 ? sum / matches_.size() : 0;
  }

  /// Sorted, and of those that are near each other the best.
  void keep_best(std::size_t most) {
    std::stable_sort(starts_.begin(), starts_.end(),
                     [](const ProposedPose& one, const ProposedPose& other) { return one.score > other.score; });
    result_.poses.clear();
    for (ProposedPose& start : starts_) {
      if (result_.poses.size() == most) break;
      const bool is_near = std::any_of(result_.poses.begin(), result_.poses.end(), [&](const ProposedPose& better) {
        return displacement_pr(matches_, start.target_from_source, better.target_from_source) < kApartPr;
      });
      if (is_near) continue;
      start.support = static_cast<int>(within(start.target_from_source).size());
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
      start.overlap = refined.before.overlap, start.rms_pr = refined.before.rms_pr;
      if (refined.target_from_source) {
        const double score = surfaces_->fine(*refined.target_from_source);
        if (score > start.score) {
          start.moved_pr = displacement_pr(matches_, start.target_from_source, *refined.target_from_source);
          start.target_from_source = *refined.target_from_source;
          start.score = score;
        }
        start.overlap = refined.after.overlap, start.rms_pr = refined.after.rms_pr;
      }
      start.in_front = surfaces_->share_in_front(start.target_from_source);
    });
    const auto is_contradicted = [](const ProposedPose& pose) { return pose.in_front > kMostInFront; };
    if (!std::all_of(starts_.begin(), starts_.end(), is_contradicted))
      starts_.erase(std::remove_if(starts_.begin(), starts_.end(), is_contradicted), starts_.end());
    all_poses_ = result_.poses;
    keep_best(starts_.size());
  }

  /// The fewer distinct points of the two sides of these rows.
  int distinct(const Indices& rows) const {
    std::set<std::tuple<double, double, double>> source, target;
    for (const int row : rows) {
      source.insert({matches_.source_points(row, 0), matches_.source_points(row, 1), matches_.source_points(row, 2)});
      target.insert({matches_.target_points(row, 0), matches_.target_points(row, 1), matches_.target_points(row, 2)});
    }
    return static_cast<int>(std::min(source.size(), target.size()));
  }

  /// Root mean square displacement of the matched points that the errors of the fit to these rows make likely, pr.
  double uncertainty_pr(const RigidTransform& pose, const Indices& rows, int m) const {
    constexpr double kUnknown = 100;
    if (m < 4) return kUnknown;
    const Points moved = pose.apply(matches_.source_points) / matches_.resolution;
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (const int row : rows) centre += moved.row(row) / static_cast<double>(rows.size());
    const auto jacobian = [&](int row) {
      const Eigen::RowVector3d x = moved.row(row) - centre;
      Eigen::Matrix<double, 3, 6> j;
      j << 0, x.z(), -x.y(), 1, 0, 0, -x.z(), 0, x.x(), 0, 1, 0, x.y(), -x.x(), 0, 0, 0, 1;
      return j;
    };
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    double squares = 0;
    for (const int row : rows) {
      const auto j = jacobian(row);
      normal += j.transpose() * j;
      squares += (moved.row(row) - matches_.target_points.row(row) / matches_.resolution).squaredNorm();
    }
    const Eigen::FullPivLU<Eigen::Matrix<double, 6, 6>> solver(normal);
    if (!solver.isInvertible()) return kUnknown;
    const Eigen::Matrix<double, 6, 6> covariance = squares / std::max(1, 3 * m - 6) * solver.inverse();
    double sum = 0;
    for (int row = 0; row < matches_.size(); ++row) {
      const auto j = jacobian(row);
      sum += (j * covariance * j.transpose()).trace();
    }
    const double found = std::sqrt(std::max(0.0, sum / matches_.size()));
    return std::isfinite(found) ? std::min(found, kUnknown) : kUnknown;
  }

  ConfidenceSignals signals() const {
    const ProposedPose& best = result_.poses.front();
    const RigidTransform& pose = best.target_from_source;
    const Indices rows = within(pose);
    const int n = matches_.size(), m = distinct(rows);
    int others = 0;
    for (const ProposedPose& other : surfaces_ ? all_poses_ : result_.poses) {
      if (!(displacement_pr(matches_, other.target_from_source, pose) > kOtherPr)) continue;
      Indices apart;
      const Indices theirs = within(other.target_from_source);
      std::set_difference(theirs.begin(), theirs.end(), rows.begin(), rows.end(), std::back_inserter(apart));
      others = std::max(others, static_cast<int>(apart.size()));
    }
    int agreeing = 0;
    for (const RigidTransform& own : own_poses_) agreeing += displacement_pr(matches_, own, pose) < kOtherPr;
    return {std::log(1.0 + m),
            std::log((m + 1.0) / (n - m + 1.0)),
            std::log((m + 1.0) / (others + 1.0)),
            -std::log(0.01 + uncertainty_pr(pose, rows, m)),
            static_cast<double>(agreeing) / static_cast<double>(std::max<std::size_t>(result_.methods.size(), 1)),
            best.overlap,
            0 - best.rms_pr / 4,
            0 - best.in_front,
            0 - std::log(1 + best.moved_pr)};
  }

  const CorrespondenceSet& matches_;
  const ParallelFor& parallel_;
  const RegistrationObserver& observer_;
  std::optional<Surfaces> surfaces_;
  std::vector<RigidTransform> own_poses_;
  std::vector<ProposedPose> starts_, all_poses_;
  Registration result_;
};

}  // namespace

int registration_steps() { return static_cast<int>(kProposers.size()) + 2; }

Registration register_pair(const CorrespondenceSet& matches, const std::optional<RegisteredSurfaces>& surfaces,
                           const ParallelFor& parallel, const RegistrationObserver& observer) {
  return PairRegistration(matches, surfaces, parallel, observer).run();
}

}  // namespace corral
