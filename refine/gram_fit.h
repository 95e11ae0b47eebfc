// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernel/rigid_transform.h"

namespace corral {

/// A sum of squares whose residuals are linear in the entries of a motion (R, t).
///
///   E(R, t) = x^T G x,   x = ( columns of R - I, t, 1 )   (13 numbers),   G = sum f f^T over the residuals r = f . x
using Gram = Eigen::Matrix<double, 13, 13>;

struct GramFit {
  RigidTransform motion;
  double squares_before, squares_after;  ///< E of no motion, and of this; never larger
};

/// The motion that minimises E, by Levenberg and Marquardt's method (Ceres, one thread) from no motion, over unit
/// quaternions and shifts with analytic derivatives; absent if there is no usable one.
std::optional<GramFit> minimise(const Gram& gram);

}  // namespace corral
