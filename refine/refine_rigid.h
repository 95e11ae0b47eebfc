// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

struct RefineOptions {
  double loss_scale_pr = 5;      ///< residual at which a match begins to lose its influence
  int maximum_iterations = 500;  ///< at least 1, of Levenberg and Marquardt's method
};

enum class RefineStatus {
  Refined,             ///< a pose was found; whether the iteration came to rest is in `converged`
  TooFewRows,          ///< fewer than 3 rows: no pose
  DegenerateGeometry,  ///< the rows lie on one line or in one place on a side: no pose
  Diverged,            ///< the optimiser found no usable pose: no pose
};

/// "refined", "too few rows", "degenerate geometry", "diverged".
const char* to_text(RefineStatus status);

using PoseCovariance = Eigen::Matrix<double, 6, 6>;

struct RefinedPose {
  RefineStatus status = RefineStatus::TooFewRows;
  std::optional<RigidTransform> initial;             ///< least squares over the rows; the start of the iteration
  std::optional<RigidTransform> target_from_source;  ///< the refined pose; absent unless the status is Refined
  bool converged = false;
  int iterations = 0;
  double initial_rms_pr = 0, final_rms_pr = 0;  ///< root mean square residual over the rows, pr
  /// Of (w, t): R = exp([w]) R_refined with w in radians about the axes of the target, t in mesh units. Present with the pose.
  std::optional<PoseCovariance> covariance;
};

/// The rigid motion that minimises the robust point-to-point cost over chosen rows.
///
///   E(R, t) = sum rho( |R p_i + t - p'_i|^2 / pr^2 ),   rho(s) = a^2 log(1 + s / a^2),  a = loss_scale_pr
///
/// started from the least-squares fit of the rows [kabsch1976solution]. R is a unit quaternion; Ceres, one thread.
/// The covariance is s^2 (sum w_i J_i^T J_i)^-1 with the weights w = rho' at the solution and s^2 the weighted mean square
/// residual over 3 M - 6 degrees of freedom.
///
/// Reads     source_points, target_points, resolution; the rows must be in range.
/// Cost      O(rows) per iteration. Deterministic: same input, same bytes.
/// Throws    InvalidInput: option out of range, invalid table, a row out of range.
RefinedPose refine_rigid(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options = {});

}  // namespace corral
