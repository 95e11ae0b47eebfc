// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernel/correspondence_set.h"
#include "kernel/types.h"

namespace corral {

/// A rigid motion of column vectors: x_in_target = rotation * x_in_source + translation (mesh units). Objects are named
/// b_from_a, so that compositions cancel visually: c_from_a = c_from_b * b_from_a.
struct RigidTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  RigidTransform operator*(const RigidTransform& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  RigidTransform inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }

  /// Moves N points (rows).
  Points apply(const Points& points) const {
    return (points * rotation.transpose()).rowwise() + translation.transpose();
  }
};

/// True if the matrix is orthonormal with every entry of R R^T within `tolerance` of the identity, and det R > 0.
bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance);

/// Least-squares rigid motion that maps each row of `source` to the same row of `target` (N x 3 each).
///
///   H = sum (p - mean p)(q - mean q)^T = U S V^T,   R = V diag(1, 1, det(V U^T)) U^T,   t = mean q - R mean p
///
/// Source    [kabsch1976solution], [umeyama1991least] without scale.
/// Returns   the motion, proper even for a mirrored or planar set; absent for fewer than 3 rows, or when the second
///           singular value of H is at most 1e-6 of the first (collinear or coincident rows), or anything is not finite.
/// Throws    InvalidInput if the two sides differ in length.
std::optional<RigidTransform> fit_rigid_transform(const Points& source, const Points& target);

/// The same over chosen rows of a table of matches. Throws InvalidInput for a row that is not there.
std::optional<RigidTransform> fit_rigid_transform(const CorrespondenceSet& matches, const Indices& rows);

/// Area of the triangle a, b, c in squared units of the points.
double triangle_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace corral
