// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kernel/rigid_transform.h"

namespace corral {

/// A sum of squared residuals that are linear in the entries of a motion (R, t).
///
///   E(R, t) = x^T G x,   x = ( columns of R - I, t, 1 )   (13 numbers),   G = sum f f^T over the residuals r = f . x
using Gram = Eigen::Matrix<double, 13, 13>;

struct GramFit {
  RigidTransform motion;
  double squares_before, squares_after;  ///< E of the identity and of `motion`; the second is never larger
};

/// The motion that minimises E, by the Levenberg-Marquardt method (Ceres, one thread) from the identity, over unit
/// quaternions and translations with analytic derivatives; absent if no usable one is found.
std::optional<GramFit> minimise(const Gram& gram);

}  // namespace corral
