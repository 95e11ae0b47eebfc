// SPDX-License-Identifier: MIT
#pragma once

// ISS a second time: every vertex asks every other one.

#include "kernel/surface/iss.h"

namespace corral::testing {

/// Saliency by vertex, with eigenvalues from a singular value decomposition of the weighted offsets.
Eigen::VectorXd reference_iss_saliency(const Points& vertices, double resolution, const IssOptions& options = {});

Keypoints reference_iss(const Points& vertices, double resolution, const IssOptions& options = {});

}  // namespace corral::testing
