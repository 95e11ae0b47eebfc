// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "kernel/rigid_transform.h"
#include "refine/robust_loss.h"

namespace corral {

/// N points and their targets: N x 3 both.
struct MatchedPoints {
  Points source, target;
};

/// The robust point-to-point cost of a pose over N pairs, with what a Gauss-Newton step needs. With
/// e = R x + c - y, s = |e|^2 and J = [ -[R x]_x  I ] (the change of e under R <- exp([w]) R, c <- c + d):
///
///   cost = sum rho(s)      gradient = sum rho'(s) J^T e      normal = sum rho'(s) J^T J
///
/// in the unit of the points (pr here) and radians; 2 `gradient` is the derivative of `cost` by (w, d).
struct RigidCost {
  double cost = 0;
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
};

RigidCost rigid_cost(const MatchedPoints& pairs, const RigidTransform& pose, const ScaledLoss& loss);

/// dw / dq: the rotation w of R <- exp([w]) R that corresponds to a small change of its unit quaternion (x, y, z, w).
Eigen::Matrix<double, 3, 4> turn_by_quaternion(const Eigen::Quaterniond& rotation);

/// [v]_x: the matrix with [v]_x a = v x a.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

}  // namespace corral
