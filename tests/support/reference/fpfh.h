// SPDX-License-Identifier: MIT
#pragma once

// FPFH a second time: from frames, cross products and arc tangents.

#include <Eigen/Core>
#include <optional>

#include "kernel/surface/fpfh.h"

namespace corral::testing {

/// theta, alpha and phi of a pair; absent where it has no frame.
struct PairAngles {
  double theta, alpha, phi;
};
std::optional<PairAngles> pair_angles(const Eigen::Vector3d& p, const Eigen::Vector3d& normal_p,
                                      const Eigen::Vector3d& q, const Eigen::Vector3d& normal_q);

/// S(p) of a vertex: 33 numbers, each third with the sum 1; zero where there is no pair.
Eigen::VectorXd reference_simple_histogram(const Points& vertices, const Points& normals, int vertex, double radius,
                                           FpfhForm form);

/// The descriptor of a vertex; absent where nothing around it has a histogram.
std::optional<Eigen::VectorXd> reference_fpfh(const Points& vertices, const Points& normals, int vertex, double radius,
                                              FpfhForm form = FpfhForm::Paper);

}  // namespace corral::testing
