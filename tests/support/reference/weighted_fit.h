// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "kernel/correspondence_set.h"

/// Poses once more, written straight from their definition.
namespace corral::reference {

struct Pose {
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift;
};

/// Weighted least squares; absent for fewer than three rows of positive weight or for rows nearly on a line.
std::optional<Pose> fit(const CorrespondenceSet& matches, const Indices& rows, const std::vector<double>& weights);

double residual(const CorrespondenceSet& matches, int row, const Pose& pose);

}  // namespace corral::reference
