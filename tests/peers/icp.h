// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral::peers {

/// Where a library's point-to-point iterative closest points end, and after how many rounds.
struct IcpResult {
  RigidTransform target_from_source;
  int rounds = 0;
};

/// With the library's defaults but for what is compared: the rounds, all of which are run, and the distance up to which
/// points are paired (mesh units). The clouds are converted once, before; the kd-tree is built within the call.
using Icp = std::function<IcpResult(const RigidTransform& start, double limit, int rounds)>;

Icp pcl_icp(const Points& source, const Points& target);     ///< coordinates are rounded to float
Icp open3d_icp(const Points& source, const Points& target);  ///< on one thread

}  // namespace corral::peers
