// SPDX-License-Identifier: MIT
#include "refine/refine_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/error.h"
#include "refine/surface_pairing.h"

namespace corral {
namespace {

constexpr int kFewestPairs = 6;  // the degrees of freedom of a pose
constexpr int kMostInVain = 3;   // rounds of a level without a new lowest cost: pairs that alternate

/// The course of a level.
struct Descent {
  RigidTransform pose;                                    ///< where it ended
  SurfaceStatus status = SurfaceStatus::Refined;          ///< why it ended, if early
  double cost = std::numeric_limits<double>::infinity();  ///< there; infinite if early
  std::vector<SurfaceRound> rounds;
};

class SurfaceRefiner {
 public:
  SurfaceRefiner(const SurfacePair& surfaces, const SurfaceOptions& options)
      : options_(options),
        unit_(surfaces.resolution),
        pairing_(surfaces, std::cos(options.largest_angle_deg * M_PI / 180)) {}

  RefinedSurface run(const RigidTransform& start) {
    pairing_.take(options_.levels.front().most_points);
    const Pairing before = pair(start);
    RefinedSurface result;
    result.before = {before.overlap(), before.rms_pr()};
    RigidTransform pose = start;
    double limit_pr = options_.levels.front().limit_pr;
    for (const SurfaceLevel& level : options_.levels) {
      Descent descent = descend(level, options_.residual, pose);
      if (level.limit_pr < limit_pr) {  // pairs within the larger one may have been misleading
        Descent other = descend(level, options_.residual, start);
        if (other.cost < descent.cost) descent = std::move(other);
      }
      limit_pr = level.limit_pr;
      result.levels.push_back(std::move(descent.rounds));
      pose = descent.pose;
      result.status = descent.status;
      if (result.status == SurfaceStatus::Diverged) break;
    }
    if (result.status == SurfaceStatus::Refined && are_points_seen_twice(pose)) {
      Descent descent = descend(options_.levels.back(), SurfaceResidual::PointToPoint, pose);
      if (descent.status == SurfaceStatus::Refined) {
        result.levels.push_back(std::move(descent.rounds));
        pose = descent.pose;
      }
    }
    judge(pose, result);
    return result;
  }

 private:
  bool is_enough(const Pairing& pairing) const {
    return pairing.pairs >= kFewestPairs && pairing.overlap() >= options_.least_overlap;
  }

  /// As on the last level.
  Pairing pair(const RigidTransform& pose) {
    return pairing_.pair(options_.residual, pose, options_.levels.back().limit_pr);
  }

  Descent descend(const SurfaceLevel& level, SurfaceResidual residual, const RigidTransform& start) {
    const auto step = static_cast<double>(pairing_.take(level.most_points));
    Descent descent;
    descent.pose = start;
    double lowest = std::numeric_limits<double>::infinity(), cost = lowest;
    int in_vain = 0;
    const auto ended = [&](SurfaceStatus status) {
      descent.status = status;
      if (status == SurfaceStatus::Refined) descent.cost = cost;
      return descent;
    };
    for (int round = 0; round < level.most_rounds; ++round) {
      const Pairing pairing = pairing_.pair(residual, descent.pose, level.limit_pr);
      if (!is_enough(pairing)) return ended(SurfaceStatus::TooLittleOverlap);
      cost = pairing.cost(level.limit_pr);
      in_vain = cost < lowest ? 0 : in_vain + 1;
      lowest = std::min(lowest, cost);
      if (in_vain == kMostInVain) break;
      const auto fit = minimise(damped(pairing));
      if (!fit) return ended(SurfaceStatus::Diverged);
      descent.rounds.push_back({pairing.overlap(), cost, fit->squares_before, fit->squares_after});
      descent.pose = about_centre(fit->motion, pairing.centre) * descent.pose;
      // No point turns farther than its distance from the centre times the norm of R - I.
      const double turn = (fit->motion.rotation - Eigen::Matrix3d::Identity()).norm();
      if (turn * pairing_.size_pr() + fit->motion.translation.norm() < options_.rest_pr * step) break;
    }
    return ended(SurfaceStatus::Refined);
  }

  /// With squares of the step itself.
  Gram damped(const Pairing& pairing) const {
    constexpr double kDamping = 1e-3;
    const double size = pairing_.size_pr(), share = kDamping * static_cast<double>(pairing.pairs);
    Gram gram = pairing.gram;
    gram.diagonal().head<9>().array() += share * size * size / 3;
    gram.diagonal().segment<3>(9).array() += share;
    return gram;
  }

  /// A step in pr about a centre, as a motion in mesh units.
  RigidTransform about_centre(const RigidTransform& step, const Eigen::Vector3d& centre) const {
    return {step.rotation, centre + unit_ * step.translation - step.rotation * centre};
  }

  /// Whether partners are the same points with noise: then their distances are as large along the surface, which has two
  /// directions, as across it, and less than by chance. Points of another sampling have no such partners, before or after a
  /// shift.
  bool are_points_seen_twice(const RigidTransform& pose) {
    constexpr double kShift_pr = 0.6, kLargestShare = 0.85, kLargestRatio = 1.5;
    if (options_.residual == SurfaceResidual::PointToPoint) return false;
    const Spread here = pairing_.spread(pair(pose));
    if (!(here.along <= 2 * kLargestRatio * here.across)) return false;
    RigidTransform beside = pose;
    beside.translation += Eigen::Vector3d::Constant(kShift_pr * unit_);
    return here.along < kLargestShare * pairing_.spread(pair(beside)).along;
  }

  /// The final assessment of a pose: overlap, residual and condition over all points.
  void judge(const RigidTransform& pose, RefinedSurface& result) {
    pairing_.take(std::numeric_limits<int>::max());
    const Pairing after = pair(pose);
    result.after = {after.overlap(), after.rms_pr()};
    result.condition =
        after.pairs >= kFewestPairs ? pairing_.condition(after.pairs) : std::numeric_limits<double>::infinity();
    if (result.status == SurfaceStatus::Diverged) return;
    if (!is_enough(after))
      result.status = SurfaceStatus::TooLittleOverlap;
    else if (!(result.condition <= options_.largest_condition))
      result.status = SurfaceStatus::DegenerateGeometry;
    else
      result.status = SurfaceStatus::Refined, result.target_from_source = pose;
  }

  const SurfaceOptions& options_;
  double unit_;  // mesh units per pr
  SurfacePairing pairing_;
};

void check(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  const std::string who = "refine_surface";
  require_positive(who, "resolution", surfaces.resolution);
  const auto check_normals = [&](const SurfacePoints& side, const std::string& name) {
    if (side.points.rows() != side.normals.rows())
      throw InvalidInput(who, name + " normals", static_cast<double>(side.normals.rows()), "one row per point");
  };
  check_normals(surfaces.source, "source");
  check_normals(surfaces.target, "target");
  if (!start.rotation.allFinite() || !start.translation.allFinite())
    throw InvalidInput(who, "start", "a value that is not finite", "a finite motion");
  if (options.levels.empty()) throw InvalidInput(who, "levels", "none", "at least one");
  for (const SurfaceLevel& level : options.levels) {
    require_positive(who, "limit_pr", level.limit_pr);
    if (level.most_points < 1) throw InvalidInput(who, "most_points", level.most_points, "at least 1");
    if (level.most_rounds < 1) throw InvalidInput(who, "most_rounds", level.most_rounds, "at least 1");
  }
  if (!(options.largest_angle_deg > 0 && options.largest_angle_deg <= 90))
    throw InvalidInput(who, "largest_angle_deg", options.largest_angle_deg, "above 0, up to 90");
  if (!(options.rest_pr >= 0)) throw InvalidInput(who, "rest_pr", options.rest_pr, "at least 0");
  if (!(options.least_overlap >= 0 && options.least_overlap <= 1))
    throw InvalidInput(who, "least_overlap", options.least_overlap, "0 to 1");
  require_positive(who, "largest_condition", options.largest_condition);
}

}  // namespace

const char* to_text(SurfaceStatus status) {
  switch (status) {
    case SurfaceStatus::Refined:
      return "refined";
    case SurfaceStatus::TooLittleOverlap:
      return "too little overlap";
    case SurfaceStatus::DegenerateGeometry:
      return "degenerate geometry";
    case SurfaceStatus::Diverged:
      break;
  }
  return "diverged";
}

RefinedSurface refine_surface(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  check(surfaces, start, options);
  return SurfaceRefiner(surfaces, options).run(start);
}

}  // namespace corral
