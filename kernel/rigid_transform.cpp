// SPDX-License-Identifier: MIT
#include "kernel/rigid_transform.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "kernel/error.h"

namespace corral {

bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance) {
  const Eigen::Vector3d x = matrix.row(0), y = matrix.row(1), z = matrix.row(2);
  const auto is_near = [=](double number, double expected) { return std::abs(number - expected) <= tolerance; };
  return is_near(x.dot(x), 1) && is_near(y.dot(y), 1) && is_near(z.dot(z), 1) && is_near(x.dot(y), 0) &&
         is_near(x.dot(z), 0) && is_near(y.dot(z), 0) && x.cross(y).dot(z) > 0;
}

std::optional<RigidTransform> fit_rigid_transform(const Points& source, const Points& target) {
  if (source.rows() != target.rows())
    throw InvalidInput("fit_rigid_transform", "target", std::to_string(target.rows()) + " rows",
                       std::to_string(source.rows()) + " rows, one per source point");
  if (source.rows() < 3) return std::nullopt;

  const Eigen::RowVector3d source_mean = source.colwise().mean();
  const Eigen::RowVector3d target_mean = target.colwise().mean();
  const Eigen::Matrix3d covariance = (source.rowwise() - source_mean).transpose() * (target.rowwise() - target_mean);
  if (!covariance.allFinite()) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (!(singular(1) > 1e-6 * singular(0))) return std::nullopt;

  Eigen::Matrix3d v = svd.matrixV();
  if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) = -v.col(2);  // the reflection case
  RigidTransform target_from_source;
  target_from_source.rotation = v * svd.matrixU().transpose();
  target_from_source.translation = target_mean.transpose() - target_from_source.rotation * source_mean.transpose();
  return target_from_source;
}

std::optional<RigidTransform> fit_rigid_transform(const CorrespondenceSet& matches, const Indices& rows) {
  check_rows(matches, rows, "fit_rigid_transform");
  return fit_rigid_transform(matches.source_points(rows, Eigen::all), matches.target_points(rows, Eigen::all));
}

double triangle_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

}  // namespace corral
