// SPDX-License-Identifier: MIT
#pragma once

// SHOT a second time: every bin asks every vertex what it gets.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "kernel/surface/shot.h"

namespace corral::testing {

/// Shell 1 beyond half the radius, above 1 for z > 0.
Eigen::Index shot_bin(int azimuth, int shell, int above, int cosine);

/// By brute force, in the order of the rows.
Support support_of(const Points& vertices, const Points& normals, const Eigen::Vector3d& point, double radius);

std::optional<LocalReferenceFrame> reference_shot_frame(const Points& vertices, const Eigen::Vector3d& point,
                                                        double radius);

/// That of the fast code, in bins of its own.
inline std::optional<Eigen::VectorXd> fresh_histogram(const Support& support, const LocalReferenceFrame& frame,
                                                      double radius, ShotForm form = ShotForm::Additive) {
  ShotBins bins;
  return shot_histogram(support, frame, radius, form, bins);
}

/// The histogram before its length is made one: what the vertices within the radius, normals not zero, add up to.
Eigen::VectorXd reference_shot_votes(const Points& vertices, const Points& normals, const Eigen::Vector3d& point,
                                     const LocalReferenceFrame& frame, double radius,
                                     ShotForm form = ShotForm::Additive);

std::optional<Eigen::VectorXd> reference_shot_histogram(const Points& vertices, const Points& normals,
                                                        const Eigen::Vector3d& point, const LocalReferenceFrame& frame,
                                                        double radius, ShotForm form = ShotForm::Additive);

}  // namespace corral::testing
