// SPDX-License-Identifier: MIT
#include "refine/refine_rigid.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernel/error.h"

namespace corral {
namespace {

/// Residual of one match: rotated point plus shift minus its partner, all in pr about the two centroids.
struct PointResidual {
  Eigen::Vector3d source, target;

  template <class T>
  bool operator()(const T* quaternion, const T* shift, T* residual) const {
    const T point[3] = {T(source.x()), T(source.y()), T(source.z())};
    ceres::QuaternionRotatePoint(quaternion, point, residual);
    for (int axis = 0; axis < 3; ++axis) residual[axis] += shift[axis] - target(axis);
    return true;
  }
};

/// The chosen rows in pr about their centroids: the two halves of a pose then hardly depend on each other, and an
/// offset of the coordinates costs no digits.
struct CentredRows {
  Points source, target;
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

double rms(const RigidTransform& pose, const CentredRows& rows) {
  return std::sqrt((pose.apply(rows.source) - rows.target).squaredNorm() / static_cast<double>(rows.source.rows()));
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Covariance of (rotation vector, shift) in the frame of the centred rows, rad and pr.
PoseCovariance centred_covariance(const RigidTransform& pose, const CentredRows& rows, double loss_scale) {
  PoseCovariance information = PoseCovariance::Zero();
  double weighted_squares = 0;
  for (Eigen::Index row = 0; row < rows.source.rows(); ++row) {
    const Eigen::Vector3d rotated = pose.rotation * rows.source.row(row).transpose();
    const double squared = (rotated + pose.translation - rows.target.row(row).transpose()).squaredNorm();
    const double weight = 1 / (1 + squared / (loss_scale * loss_scale));  // rho'
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << -cross_matrix(rotated), Eigen::Matrix3d::Identity();
    information += weight * jacobian.transpose() * jacobian;
    weighted_squares += weight * squared;
  }
  const double freedom = 3.0 * static_cast<double>(rows.source.rows()) - 6.0;
  return weighted_squares / freedom * information.inverse();
}

/// The pose in mesh units from the pose of the centred rows.
RigidTransform uncentred(const RigidTransform& pose, const CentredRows& rows, double resolution) {
  return {pose.rotation, rows.target_mean + resolution * pose.translation - pose.rotation * rows.source_mean};
}

PoseCovariance uncentred(const PoseCovariance& covariance, const RigidTransform& pose, const CentredRows& rows,
                         double resolution) {
  // t = c - R mean: a turn by w moves t by [R mean] w beside what it does to c.
  PoseCovariance change = PoseCovariance::Identity();
  change.bottomRightCorner<3, 3>() *= resolution;
  change.bottomLeftCorner<3, 3>() = cross_matrix(pose.rotation * rows.source_mean);
  return change * covariance * change.transpose();
}

ceres::Solver::Summary solve(const CentredRows& rows, const RefineOptions& options, RigidTransform& pose) {
  const Eigen::Quaterniond start(pose.rotation);
  double quaternion[4] = {start.w(), start.x(), start.y(), start.z()};
  ceres::CauchyLoss loss(options.loss_scale_pr);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddParameterBlock(quaternion, 4, new ceres::QuaternionManifold);
  problem.AddParameterBlock(pose.translation.data(), 3);
  for (Eigen::Index row = 0; row < rows.source.rows(); ++row) {
    auto* residual = new PointResidual{rows.source.row(row).transpose(), rows.target.row(row).transpose()};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointResidual, 3, 4, 3>(residual), &loss, quaternion,
                             pose.translation.data());
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;  // Ceres sums per thread: more threads, other bits
  solver.max_num_iterations = options.maximum_iterations;
  solver.function_tolerance = 1e-14;
  solver.gradient_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  pose.rotation =
      Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]).normalized().toRotationMatrix();
  return summary;
}

void check(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options) {
  matches.validate();
  require_positive("refine_rigid", "loss_scale_pr", options.loss_scale_pr);
  if (options.maximum_iterations < 1)
    throw InvalidInput("refine_rigid", "maximum_iterations", options.maximum_iterations, "at least 1");
  check_rows(matches, rows, "refine_rigid");
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

RefinedPose refine_rigid(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options) {
  check(matches, rows, options);
  RefinedPose refined;
  if (rows.size() < 3) return refined;

  const CentredRows centred(matches, rows);
  const auto start = fit_rigid_transform(centred.source, centred.target);
  if (!start) {
    refined.status = RefineStatus::DegenerateGeometry;
    return refined;
  }
  refined.initial = uncentred(*start, centred, matches.resolution);
  refined.initial_rms_pr = rms(*start, centred);

  RigidTransform pose = *start;
  const ceres::Solver::Summary summary = solve(centred, options, pose);
  refined.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  refined.converged = summary.termination_type == ceres::CONVERGENCE;
  refined.final_rms_pr = rms(pose, centred);
  const PoseCovariance covariance =
      uncentred(centred_covariance(pose, centred, options.loss_scale_pr), pose, centred, matches.resolution);
  if (!summary.IsSolutionUsable() || !covariance.allFinite()) {
    refined.status = RefineStatus::Diverged;
    refined.converged = false;
    return refined;
  }
  refined.status = RefineStatus::Refined;
  refined.target_from_source = uncentred(pose, centred, matches.resolution);
  refined.covariance = (covariance + covariance.transpose()) / 2;  // symmetric to the last bit
  return refined;
}

}  // namespace corral
