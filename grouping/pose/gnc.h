// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// The weight of a row with a squared residual of e^2 at the bound c and the stage mu of fit_gnc().
double gnc_weight(double squared_residual, double squared_bound, double mu);

/// The pose of truncated least squares over some rows by graduated non-convexity: from all rows alike to those within the
/// bound c (mesh units) alone.
///
///   T = fit_weighted(1);   mu = 1 / (2 max e^2 / c^2 - 1), unless that is not positive: all rows fit
///   w = 0 where e^2 >= c^2 (mu+1)/mu,   1 where e^2 <= c^2 mu/(mu+1),   else c sqrt(mu(mu+1)) / e - mu
///   T = fit_weighted(w);   mu <- 1.4 mu;   until all w are 0 or 1, sum w e^2 changes by less than 1e-6 c^2, or 100 rounds
///
/// Source    [yang2020graduated], [yang2021teaser].
/// Returns   the last pose that could be fitted; absent if the first could not.
/// Departs   Fits the whole pose at once, to the rows themselves and not to their differences; the change of the cost is
///           measured in c^2, so that the unit of length does not matter.
std::optional<RigidTransform> fit_gnc(const CorrespondenceSet& matches, const Indices& rows, double bound);

}  // namespace corral
