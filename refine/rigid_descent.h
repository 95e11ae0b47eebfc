// SPDX-License-Identifier: MIT
#pragma once

#include "refine/rigid_cost.h"

namespace corral {

/// Where a descent of the cost of rigid_cost.h ended.
struct RigidDescent {
  RigidTransform pose;     ///< the start, if nothing usable was found
  double cost = 0;         ///< at the pose; never above that of the start
  bool is_usable = false;  ///< the cost is finite, and the pairs that keep a weight fix a pose
  bool converged = false;  ///< came to rest
  int iterations = 0;      ///< of Levenberg and Marquardt's method, all descents together
};

/// Minimises the cost over the rigid motions with Ceres, one thread. A loss whose weights end in nothing (tukey,
/// geman-mcclure) is descended twice, from the start at once, and by graduated non-convexity [blake1987visual]
/// [yang2020graduated]: from the smallest scale at which all residuals of the start lie where rho is convex, halved down to
/// the scale of the loss. The lower cost stands.
///
/// `pairs`: at least 3, centred, not on a line. `maximum_iterations` is for all descents together.
/// Deterministic: same input, same bytes.
/// Departs   [yang2020graduated] divides a^2 by 1.4 and solves each round in closed form; here a halves, Ceres solves, and
///           the descent from the start at once competes, so that the cost never rises.
RigidDescent descend_rigid_cost(const MatchedPoints& pairs, const RigidTransform& start, const ScaledLoss& loss,
                                int maximum_iterations);

}  // namespace corral
