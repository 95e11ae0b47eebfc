// SPDX-License-Identifier: MIT
#pragma once

#include "refine/rigid_cost.h"

namespace corral {

/// Where a descent of the cost of rigid_cost.h ended.
struct RigidDescent {
  RigidTransform pose;     ///< the start, if no usable pose was found
  double cost = 0;         ///< at the pose; never above that of the start
  bool is_usable = false;  ///< the cost is finite, and the pairs with remaining weight determine a pose
  bool converged = false;
  int iterations = 0;  ///< of the Levenberg-Marquardt method, over all descents
};

/// Minimises the cost over the rigid motions with Ceres, one thread. A loss whose weights tend to zero (tukey,
/// geman-mcclure) is minimised twice, directly from the start, and by graduated non-convexity [blake1987visual]
/// [yang2020graduated]: from the smallest scale at which all residuals of the start lie where rho is convex, halved down to
/// the scale of the loss. The lower cost is kept.
///
/// `pairs`: at least 3, centred, not on a line. `maximum_iterations` is for all descents together.
/// Deterministic: same input, same bytes.
/// Departs   [yang2020graduated] divides a^2 by 1.4 and solves each round in closed form; here a is halved, Ceres solves, and
///           the result is compared with direct minimisation, so that the cost never increases.
RigidDescent descend_rigid_cost(const MatchedPoints& pairs, const RigidTransform& start, const ScaledLoss& loss,
                                int maximum_iterations);

}  // namespace corral
