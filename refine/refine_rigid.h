// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"
#include "refine/robust_loss.h"

namespace corral {

struct RefineOptions {
  RobustLoss loss = RobustLoss::Cauchy;
  double loss_scale_pr = 5;  ///< above 0: residual at which a match begins to lose its influence (tukey: has none left)
  int maximum_iterations = 500;  ///< at least 1, of the Levenberg-Marquardt method, over all descents
};

enum class RefineStatus {
  Refined,             ///< a pose was found; whether the iteration converged is in `converged`
  TooFewRows,          ///< fewer than 3 rows: no pose
  DegenerateGeometry,  ///< on one side the rows lie on a line or at a point, or leave a rotation undetermined: no pose
  Diverged,            ///< no usable pose, or one that the rows with remaining weight do not determine: no pose
};

/// "refined", "too few rows", "degenerate geometry", "diverged".
const char* to_text(RefineStatus status);

using PoseCovariance = Eigen::Matrix<double, 6, 6>;

struct RefinedPose {
  RefineStatus status = RefineStatus::TooFewRows;
  std::optional<RigidTransform> initial;             ///< the start of the iteration
  std::optional<RigidTransform> target_from_source;  ///< the refined pose; absent unless the status is Refined
  bool converged = false;
  int iterations = 0;
  double initial_rms_pr = 0, final_rms_pr = 0;  ///< root mean square residual over the rows, pr
  double initial_cost = 0, final_cost = 0;      ///< E below, pr^2; the final one is never larger
  /// Largest over smallest eigenvalue of sum w_i J_i^T J_i at the solution, the rows centred, in pr and radians: grows with
  /// the squared extent in pr, and without bound as the rows approach a line.
  std::optional<double> condition;
  /// Of (w, t): R = exp([w]) R_refined with w in radians about the axes of the target, t in mesh units. Present with the pose.
  std::optional<PoseCovariance> covariance;
};

/// The rigid motion that minimises the robust point-to-point cost over M chosen rows.
///
///   E(R, t) = sum rho( |R p_i + t - p'_i|^2 / pr^2 ),   rho of robust_loss.h with a = loss_scale_pr
///
/// Starts from `start` if given (such as a grouper's own pose), else from the least-squares fit [kabsch1976solution].
/// R is a unit quaternion, the rows are centred; tukey and geman-mcclure by graduated non-convexity (rigid_descent.h).
///
/// The covariance is that of [huber1981robust] sec. 7.6, s^2 N^-1 with N = sum w J^T J, w = rho', and
///
///   s^2 = K^2 (sum w^2 |e|^2 / (3 M - 6)) (mean w) / (mean b)^2,   K = 1 + 6 / (3 M) var(b) / (mean b)^2,
///
/// b = w + 2/3 |e|^2 rho'' being the slope of w e, the mean of its three axes. Loss none: the usual mean square residual over
/// 3 M - 6 degrees of freedom. It holds, to first order, for isotropic noise and gross errors that are distributed like the
/// rows.
///
/// Reads     source_points, target_points, resolution; the rows must be in range.
/// Cost      O(rows) per iteration. Deterministic: same input, same bytes.
/// Throws    InvalidInput: option out of range, invalid table, a row out of range, a start that is not rigid to 1e-4.
/// Departs   [huber1981robust] uses J^T J of all rows for N; here the weighted sum, times M / sum w, replaces it.
RefinedPose refine_rigid(const CorrespondenceSet& matches, const Indices& rows, const RefineOptions& options = {},
                         const std::optional<RigidTransform>& start = std::nullopt);

/// refine_rigid() of all rows from a pose that was found before, by a loss without influence beyond its scale: matches that the
/// selection missed take part, wrong ones that it held drop out. Options: Tukey's loss with a scale of 5 pr.
RefinedPose refine_over_all(const CorrespondenceSet& matches, const RigidTransform& start);

}  // namespace corral
