// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/surface/mesh.h"
#include "kernel/surface/neighborhood.h"

namespace corral {

struct HarrisOptions {
  double radius_pr = 3;           ///< of the normals, the response and the non-maxima suppression
  double support_radius_pr = 15;  ///< of the descriptor that will sit on the keypoint
  int minimum_support = 10;       ///< vertices other than the keypoint that this radius must hold
};

struct Keypoints {
  Indices vertices;               ///< ascending
  int candidates = 0;             ///< local maxima before the support was counted
  int dropped_small_support = 0;  ///< candidates with too few vertices around them
};

/// Harris 3D keypoints: vertices where the normals around vary in all three directions.
///
///   A_i = mean over |x_j - x_i| <= rho of n_j n_j^T        response_i = det A_i, in [0, 1/27]
///
/// with n_j the plane normal of the vertices within rho of x_j (of either sign; absent for fewer than 3 vertices, or all on
/// one line: x_j is then left out). A keypoint is the largest response within
/// rho, and at least 1e-9.
///
/// Source    [sipiran2011harris] in the form of the point-cloud operator with Harris response that the program of
///           [yang2017evaluation] calls; since every n is a unit vector, its trace is 1 and the response is the determinant.
/// Cost      O(V m) time and memory, m vertices within rho.
/// Throws    InvalidInput if a radius or `resolution` is not finite and positive, or if the radius holds over 500 vertices
///           on average (and over 2e7 in all).
/// Departs   The determinant is taken in double, without the +0.04 - 0.04 that leaves float noise on flat ground; ties go
///           to the lower index (there, all of them stay). The keypoint itself does not count for its support.
Keypoints detect_harris(const Mesh& mesh, const PointIndex& index, double resolution,
                        const HarrisOptions& options = {});

/// The response of every vertex, V; 0 where a vertex has no normal around it.
Eigen::VectorXd harris_response(const Points& vertices, const std::vector<std::vector<Neighbor>>& neighborhoods);

}  // namespace corral
