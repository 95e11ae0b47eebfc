// SPDX-License-Identifier: MIT
#include "tests/support/reference/weighted_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace corral::reference {

std::optional<Pose> fit(const CorrespondenceSet& matches, const Indices& rows, const std::vector<double>& weights) {
  Eigen::Vector3d p_mean = Eigen::Vector3d::Zero(), q_mean = p_mean;
  double sum = 0;
  int positive = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sum += weights[i], positive += weights[i] > 0;
    p_mean += weights[i] * matches.source_points.row(rows[i]).transpose();
    q_mean += weights[i] * matches.target_points.row(rows[i]).transpose();
  }
  if (positive < 3) return std::nullopt;
  p_mean /= sum, q_mean /= sum;
  Eigen::MatrixXd p(3, rows.size()), q(3, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    p.col(column) = std::sqrt(weights[i]) * (matches.source_points.row(rows[i]).transpose() - p_mean);
    q.col(column) = std::sqrt(weights[i]) * (matches.target_points.row(rows[i]).transpose() - q_mean);
  }
  for (const Eigen::MatrixXd* side : {&p, &q}) {
    if (!side->allFinite()) return std::nullopt;
    if (!(Eigen::JacobiSVD<Eigen::MatrixXd>(*side).singularValues()(1) > 1e-3 * matches.resolution * std::sqrt(sum)))
      return std::nullopt;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(p * q.transpose(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d turn = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  return Pose{turn, q_mean - turn * p_mean};
}

double residual(const CorrespondenceSet& matches, int row, const Pose& pose) {
  return (pose.turn * matches.source_points.row(row).transpose() + pose.shift -
          matches.target_points.row(row).transpose())
      .norm();
}

}  // namespace corral::reference
