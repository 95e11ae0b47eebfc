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

/// How much two surfaces share, 0 .. 1: the vertices with one of the other surface within `threshold` (mesh units; 2 pr in
/// the field), counted on both, the smaller count over the smaller number of vertices. 0 if one has none.
///
/// Source    [yang2017evaluation] for the ratio; it leaves the threshold and the direction open.
double overlap_share(const Points& source, const Points& target, const RigidTransform& target_from_source,
                     double threshold);

}  // namespace corral
