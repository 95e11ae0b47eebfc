// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// What tells a right pose from a wrong one without a truth; all finite, larger is safer.
constexpr std::size_t kSignals = 9;
constexpr std::array<const char*, kSignals> kSignalNames = {"support",
                                                            "support share",
                                                            "lead over other poses",
                                                            "certainty of the fit",
                                                            "agreement of groupers",
                                                            "overlap",
                                                            "residual",
                                                            "free space",
                                                            "stability"};
using ConfidenceSignals = std::array<double, kSignals>;

/// Residual up to which a match agrees with a pose, pr.
constexpr double kAgreeingPr = 5;

/// The matches within kAgreeingPr of a pose.
Indices agreeing_rows(const CorrespondenceSet& matches, const RigidTransform& pose);

/// The mean of 1 - (e/5 pr)^2 over all matches, 0 beyond 5 pr: how well a pose explains a table.
double table_score(const CorrespondenceSet& matches, const RigidTransform& pose);

/// Mean displacement of the matched source points from one pose to the other, pr.
double pose_distance_pr(const CorrespondenceSet& matches, const RigidTransform& a, const RigidTransform& b);

/// What other poses of a pair there are.
struct OtherPoses {
  std::vector<RigidTransform> all;  ///< that were found, refined; the pose in question may be among them
  std::vector<RigidTransform> own;  ///< of each grouper that has one, its first
  int groupers = 0;                 ///< that could have had one
};

/// How the surfaces lie on each other under a pose; all 0 of a table alone.
struct SurfaceEvidence {
  double overlap = 0, rms_pr = 0;  ///< of the dense refinement (SurfaceFit)
  double moved_pr = 0;             ///< mean displacement of the matched source points by the dense refinement
  double in_front = 0;             ///< share of points in front of what the other sensor saw, where sensors are known
};

/// The signals of a pose.
///
/// Signals   (S: the n' matches within 5 pr of the pose T, m = the fewer distinct points of the two sides, n all matches)
///           ln(1 + m); ln((m+1)/(n-m+1)); ln((m+1)/(m2+1)) with m2 the most matches outside S within 5 pr of one other pose, more
///           than 10 pr from T; -ln(0.01 + u) with u the root mean square displacement of the matched points predicted by
///           s^2 (sum J^T J)^-1, s^2 = sum e^2 / max(1, 3m-6), 100 if singular or m < 4, pr; the share of the groupers whose own pose is
///           within 10 pr of T; overlap; -rms/4 pr; -in_front; -ln(1 + moved_pr).
ConfidenceSignals confidence_signals(const CorrespondenceSet& matches, const RigidTransform& pose,
                                     const OtherPoses& others, const SurfaceEvidence& surfaces = {});

}  // namespace corral
