// SPDX-License-Identifier: MIT
#include "kernel/rigid_transform.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "kernel/error.h"

namespace corral {

bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance) {
  const double *const a = matrix.data(), *const b = a + 3, *const c = a + 6;  // the columns
  const auto dot = [&](int i, int j) { return a[i] * a[j] + b[i] * b[j] + c[i] * c[j]; };
  const auto is_near = [=](double number, double expected) { return std::abs(number - expected) <= tolerance; };
  return is_near(dot(0, 0), 1) && is_near(dot(1, 1), 1) && is_near(dot(2, 2), 1) && is_near(dot(0, 1), 0) &&
         is_near(dot(0, 2), 0) && is_near(dot(1, 2), 0) &&
         (b[0] * c[1] - c[0] * b[1]) * a[2] + (c[0] * a[1] - a[0] * c[1]) * b[2] + (a[0] * b[1] - b[0] * a[1]) * c[2] >
             0;
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
