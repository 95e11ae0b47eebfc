// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Least-squares rigid motion of chosen matches with a weight for each:
///
///   c = sum w p / sum w,  c' = sum w p' / sum w,   H = sum w (p - c)(p' - c')^T = U S V^T
///   R = V diag(1, 1, det(V U^T)) U^T,   t = c' - R c
///
/// Source    [kabsch1976solution], [umeyama1991least] without scale.
/// Reads     source_points, target_points, resolution; rows ascending or not, each with a weight of at least 0.
/// Returns   the motion; absent for fewer than 3 rows of positive weight, for rows that lie nearly on a line on either side
///           (the second singular value of the centred points, each times the root of its weight, is at most
///           1e-3 pr sqrt(sum w)), or for anything that is not finite.
std::optional<RigidTransform> fit_weighted(const CorrespondenceSet& matches, const Indices& rows,
                                           const std::vector<double>& weights);

}  // namespace corral
