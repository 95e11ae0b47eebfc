// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

struct HarrisOptions {
  double radius_pr = 3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"radius_pr", "pr", "3", "radius of the normals, the response and the non-maxima suppression",
                      above(0)},
          self.radius_pr);
  }
};

/// Harris 3D keypoints: vertices where the normals around vary in all three directions.
///
///   A_i = mean over |x_j - x_i| <= rho of n_j n_j^T        response_i = det A_i, in [0, 1/27]
///
/// with n_j the plane normal of the vertices within rho of x_j (of either sign; absent for fewer than 3 vertices, or all on
/// one line: x_j is then left out). A keypoint is the largest response within rho, and at least 1e-9.
///
/// Source    [sipiran2011harris] in the form of the point-cloud operator with Harris response that the program of
///           [yang2017evaluation] calls; since every n is a unit vector, its trace is 1 and the response is the determinant.
/// Cost      O(V m) time, m vertices within rho; O(V) memory. Any number of threads gives the same bits.
/// Throws    InvalidInput if the radius or `resolution` is not finite and positive, or if the radius holds over 500 vertices
///           on average (and over 2e7 in all).
/// Departs   The determinant is taken in double, without the +0.04 - 0.04 that leaves float noise on flat ground; ties go
///           to the lower index (there, all of them stay).
/// Plain form  tests/support/reference/surface.h
Keypoints detect_harris(const Points& vertices, double resolution, const HarrisOptions& options = {},
                        const ParallelFor& parallel = one_by_one);

/// The response of every vertex, V, for rho in mesh units; 0 where a vertex has no normal around it.
/// Plain form  tests/support/reference/surface.h
Eigen::VectorXd harris_response(const Points& vertices, double radius, const ParallelFor& parallel = one_by_one);

}  // namespace corral
