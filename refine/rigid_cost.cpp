// SPDX-License-Identifier: MIT
#include "refine/rigid_cost.h"

namespace corral {

RigidCost rigid_cost(const MatchedPoints& pairs, const RigidTransform& pose, const ScaledLoss& loss) {
  RigidCost sums;
  double weights = 0;
  Eigen::Vector3d pull = Eigen::Vector3d::Zero(), torque = pull, arms = pull;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (Eigen::Index row = 0; row < pairs.source.rows(); ++row) {
    const Eigen::Vector3d arm = pose.rotation * pairs.source.row(row).transpose();
    const Eigen::Vector3d error = arm + pose.translation - pairs.target.row(row).transpose();
    const LossValue at = evaluate_loss(loss, error.squaredNorm());
    sums.cost += at.cost;
    if (at.weight == 0) continue;  // adds nothing below
    weights += at.weight;
    pull += at.weight * error;
    torque += at.weight * arm.cross(error);
    arms += at.weight * arm;
    spread += at.weight * arm * arm.transpose();
  }
  sums.gradient << torque, pull;
  // [r]_x^T [r]_x = |r|^2 I - r r^T, and the mixed part is (-[r]_x)^T I = [r]_x.
  sums.normal << spread.trace() * Eigen::Matrix3d::Identity() - spread, cross_matrix(arms),
      cross_matrix(arms).transpose(), weights * Eigen::Matrix3d::Identity();
  return sums;
}

Eigen::Matrix<double, 3, 4> turn_by_quaternion(const Eigen::Quaterniond& rotation) {
  // exp([w]) is the quaternion (w / 2, 1) for small w, so w / 2 is the vector part of dq q^-1.
  Eigen::Matrix<double, 3, 4> turn;
  turn << rotation.w() * Eigen::Matrix3d::Identity() + cross_matrix(rotation.vec()), -rotation.vec();
  return 2 * turn;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace corral
