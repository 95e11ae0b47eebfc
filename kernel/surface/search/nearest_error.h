// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/rigid_transform.h"
#include "kernel/surface/search/nearest_points.h"

namespace corral {

/// How far an estimate carries a symmetric object from where the truth carries it (ADD-S): the mean distance of its points,
/// placed by the truth, to the nearest of its points, placed by the estimate.
///
///   e = 1/N sum_x min_y | T_truth x - T_estimate y |     the distance of T_estimate^-1 T_truth x to the nearest y
///
/// Source    [hinterstoisser2012model], the score of ambiguous objects.
/// Reads     V points and their tree; no point gives 0.
/// Returns   the mean, in units of the points.
/// Cost      O(N log V).
/// Departs   Of more than 2,000 points x is every k-th, with the least k that leaves no more; y is any.
double nearest_error(const RigidTransform& estimate, const RigidTransform& truth, const Points& points,
                     const PointTree& tree);

}  // namespace corral
