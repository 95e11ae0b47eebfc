// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh.h"
#include "kernel/surface/neighborhood.h"

namespace corral {

/// Unit normals, V x 3: the direction of least variance of the k nearest vertices (the vertex itself among them), turned
/// to the side of the area-weighted sum of the face normals where that is not zero, else towards a sensor at the origin.
/// A row is zero where fewer than 3 distinct neighbours, or all on one line, give no direction.
///
/// Source    [rusu2009thesis]; k = 20 after the program of [yang2017evaluation].
/// Departs   The authors turn every normal towards the origin, which on closed models flips neighbours against each other;
///           with faces we take their side, on a noisy mesh that of its own faces.
/// Throws    InvalidInput for k < 3.
Points estimate_normals(const Mesh& mesh, const PointIndex& index, int k = 20);

/// Direction of least variance of some points about their mean; zero if fewer than 3 or all on one line. Sign arbitrary.
Eigen::Vector3d plane_normal(const Points& points, const std::vector<Neighbor>& rows);

}  // namespace corral
