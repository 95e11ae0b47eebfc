// SPDX-License-Identifier: MIT
#pragma once

// The surface room a second time: plain, slow and straight from the definitions, to compare with.

#include <Eigen/Core>
#include <vector>

#include "kernel/surface/harris.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/search/neighborhood.h"
#include "kernel/surface/search/resolution.h"

namespace corral::testing {

/// All points with |x - center| <= radius, ascending by index.
std::vector<Neighbor> reference_within(const Points& points, const Eigen::Vector3d& center, double radius);

/// The `count` nearest points, nearest first, the lower index first among equals.
std::vector<Neighbor> reference_nearest(const Points& points, const Eigen::Vector3d& query, int count);

/// The row nearest to each query within the limit (inclusive), the lowest of several; -1 if there is none.
Indices reference_nearest_rows(const Points& points, const Points& queries, double limit);

/// Mean over the distinct points of the distance to the nearest other one.
double reference_resolution(const Points& points);
PointSpacing reference_spacing(const Points& points);

/// Direction of least variance by a singular value decomposition; zero if there is none.
Eigen::Vector3d reference_plane_normal(const Points& points, const std::vector<Neighbor>& rows);

/// Normals of the k nearest vertices, turned to the side of the faces or towards the origin.
Points reference_normals(const Mesh& mesh, int k);

/// Determinant of the mean of n n^T within `radius`, per vertex.
Eigen::VectorXd reference_harris_response(const Points& vertices, double radius);

Keypoints reference_harris(const Points& vertices, double resolution, const HarrisOptions& options);

}  // namespace corral::testing
