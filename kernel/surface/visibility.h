// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh.h"
#include "kernel/surface/neighborhood.h"

namespace corral {

/// The source vertices that the two surfaces share: those whose true image has a target vertex within `threshold` (mesh
/// units; the field takes 4 pr). Registration errors are averaged over them.
///
/// Source    the evaluation programs behind [yang2017evaluation]'s successors (RMSE on U3M).
Points overlap_points(const Points& source, const PointIndex& target_index, const RigidTransform& target_from_source,
                      double threshold);

}  // namespace corral
