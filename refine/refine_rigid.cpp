// SPDX-License-Identifier: MIT
#include "refine/refine_rigid.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

#include "kernel/error.h"
#include "refine/rigid_descent.h"

namespace corral {
namespace {

/// If the second scatter is at most this share of the largest, the points are on a line: the limit of fit_rigid_transform.
constexpr double kThinnest = 1e-6;

/// The chosen rows in pr about their centroids: rotation and translation are then nearly uncorrelated, and an offset of the
/// coordinates costs no precision.
struct CentredRows : MatchedPoints {
  Eigen::Vector3d source_mean, target_mean;  // mesh units

  CentredRows(const CorrespondenceSet& matches, const Indices& rows) {
    source = matches.source_points(rows, Eigen::all);
    target = matches.target_points(rows, Eigen::all);
    source_mean = source.colwise().mean().transpose();
    target_mean = target.colwise().mean().transpose();
    source = (source.rowwise() - source_mean.transpose()) / matches.resolution;
    target = (target.rowwise() - target_mean.transpose()) / matches.resolution;
  }
};

/// False for points on one line, or coincident up to the rounding of coordinates as large as `mean`, or NaN.
bool span_a_plane(const Points& centred, double mean = 0) {
  const Eigen::Vector3d scatter =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centred.transpose() * centred, Eigen::EigenvaluesOnly)
          .eigenvalues();
  const double rounding = 1e-15 * mean;
  return scatter(1) > kThinnest * scatter(2) && scatter(2) > static_cast<double>(centred.rows()) * rounding * rounding;
}

/// The same for the source points, weighted.
bool kept_rows_span_a_plane(const RigidTransform& pose, const MatchedPoints& pairs, const ScaledLoss& loss) {
  Eigen::VectorXd weights = (pose.apply(pairs.source) - pairs.target).rowwise().squaredNorm();
  for (double& weight : weights) weight = evaluate_loss(loss, weight).weight;
  const Eigen::RowVector3d mean = weights.transpose() * pairs.source / weights.sum();
  return span_a_plane(weights.cwiseSqrt().asDiagonal() * (pairs.source.rowwise() - mean));
}

double rms(const RigidTransform& pose, const MatchedPoints& pairs) {
  return std::sqrt((pose.apply(pairs.source) - pairs.target).squaredNorm() / static_cast<double>(pairs.source.rows()));
}

/// The pose in mesh units from the pose of the centred rows, and back.
RigidTransform uncentred(const RigidTransform& pose, const CentredRows& rows, double resolution) {
  return {pose.rotation, rows.target_mean + resolution * pose.translation - pose.rotation * rows.source_mean};
}
RigidTransform centred_pose(const RigidTransform& pose, const CentredRows& rows, double resolution) {
  const Eigen::Matrix3d rotation = Eigen::Quaterniond(pose.rotation).normalized().toRotationMatrix();
  return {rotation, (rotation * rows.source_mean + pose.translation - rows.target_mean) / resolution};
}

PoseCovariance uncentred(const PoseCovariance& covariance, const RigidTransform& pose, const CentredRows& rows,
                         double resolution) {
  // t = c - R mean: a turn by w moves t by [R mean] w beside what it does to c.
  PoseCovariance change = PoseCovariance::Identity();
  change.bottomRightCorner<3, 3>() *= resolution;
  change.bottomLeftCorner<3, 3>() = cross_matrix(pose.rotation * rows.source_mean);
  const PoseCovariance moved = change * covariance * change.transpose();
  return (moved + moved.transpose()) / 2;  // symmetric to the last bit
}

/// s^2 of the header.
double residual_variance(const RigidTransform& pose, const MatchedPoints& pairs, const ScaledLoss& loss) {
  const double count = static_cast<double>(pairs.source.rows());
  const Eigen::VectorXd squares = (pose.apply(pairs.source) - pairs.target).rowwise().squaredNorm();
  double pulls = 0, weights = 0, slopes = 0, slope_squares = 0;
  for (const double squared : squares) {
    const LossValue at = evaluate_loss(loss, squared);
    const double slope = at.weight + at.bend * 2 / 3;
    pulls += at.weight * at.weight * squared;
    weights += at.weight;
    slopes += slope;
    slope_squares += slope * slope;
  }
  const double mean_slope = slopes / count;
  const double small_sample = 1 + 2 / count * (slope_squares / count / (mean_slope * mean_slope) - 1);
  return small_sample * small_sample * pulls / (3 * count - 6) * weights / count / (mean_slope * mean_slope);
}

void check(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options,
           const std::optional<RigidTransform>& start) {
  matches.validate();
  require_positive("refine_rigid", "loss_scale_pr", options.loss_scale_pr);
  if (options.maximum_iterations < 1)
    throw InvalidInput("refine_rigid", "maximum_iterations", options.maximum_iterations, "at least 1");
  if (start && !(is_rotation(start->rotation, 1e-4) && start->translation.allFinite()))
    throw InvalidInput("refine_rigid", "start", "a motion that is not rigid",
                       "an orthonormal rotation (to 1e-4) and a finite translation");
  check_rows(matches, rows, "refine_rigid");
}

/// Fills in what follows from the pose of the centred rows; false if they do not determine it.
bool describe(const RigidDescent& found, const CentredRows& rows, const ScaledLoss& loss, double resolution,
              RefinedPose& refined) {
  const PoseCovariance normal = rigid_cost(rows, found.pose, loss).normal;
  const Eigen::Matrix<double, 6, 1> values =
      Eigen::SelfAdjointEigenSolver<PoseCovariance>(normal, Eigen::EigenvaluesOnly).eigenvalues();
  const PoseCovariance covariance =
      uncentred(residual_variance(found.pose, rows, loss) * normal.inverse(), found.pose, rows, resolution);
  if (!(values(0) > 0) || !covariance.allFinite() || !kept_rows_span_a_plane(found.pose, rows, loss)) return false;
  refined.target_from_source = uncentred(found.pose, rows, resolution);
  refined.converged = found.converged;
  refined.final_rms_pr = rms(found.pose, rows);
  refined.final_cost = found.cost;
  refined.condition = values(5) / values(0);
  refined.covariance = covariance;
  return true;
}

}  // namespace

const char* to_text(RefineStatus status) {
  switch (status) {
    case RefineStatus::Refined:
      return "refined";
    case RefineStatus::TooFewRows:
      return "too few rows";
    case RefineStatus::DegenerateGeometry:
      return "degenerate geometry";
    case RefineStatus::Diverged:
      break;
  }
  return "diverged";
}

RefinedPose refine_rigid(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options,
                         const std::optional<RigidTransform>& start) {
  check(matches, rows, options, start);
  RefinedPose refined;
  if (rows.size() < 3) return refined;

  const CentredRows centred(matches, rows);
  refined.status = RefineStatus::DegenerateGeometry;
  if (!span_a_plane(centred.source, centred.source_mean.norm() / matches.resolution) ||
      !span_a_plane(centred.target, centred.target_mean.norm() / matches.resolution))
    return refined;
  const auto initial =
      start ? centred_pose(*start, centred, matches.resolution) : fit_rigid_transform(centred.source, centred.target);
  if (!initial) return refined;

  const ScaledLoss loss{options.loss, options.loss_scale_pr};
  refined.status = RefineStatus::Diverged;
  refined.initial = start ? *start : uncentred(*initial, centred, matches.resolution);
  refined.initial_rms_pr = rms(*initial, centred);
  refined.initial_cost = rigid_cost(centred, *initial, loss).cost;
  const RigidDescent found = descend_rigid_cost(centred, *initial, loss, options.maximum_iterations);
  refined.iterations = found.iterations;
  if (found.is_usable && describe(found, centred, loss, matches.resolution, refined))
    refined.status = RefineStatus::Refined;
  return refined;
}

RefinedPose refine_over_all(const CorrespondenceSet& matches, const RigidTransform& start) {
  Indices all(static_cast<std::size_t>(matches.size()));
  std::iota(all.begin(), all.end(), 0);
  RefineOptions options;
  options.loss = RobustLoss::Tukey;
  return refine_rigid(matches, all, options, start);
}

}  // namespace corral
