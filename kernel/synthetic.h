// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// A random table of matches with a known pose.
struct SyntheticOptions {
  int matches = 500;
  double inlier_ratio = 0.5;   ///< share of correct matches, 0 .. 1; their number is rounded to the nearest
  double noise_pr = 0.5;       ///< standard deviation of each target coordinate of a correct match
  double extent_pr = 200;      ///< side of the cube that holds the source points
  double frame_noise_deg = 3;  ///< angle by which the target frame of a correct match is turned about a random axis
  double resolution = 1.0;     ///< mesh units per pr
  std::uint64_t seed = 1;
};

struct SyntheticProblem {
  CorrespondenceSet matches;  ///< every column filled
  RigidTransform truth;       ///< target_from_source
  Indices inliers;            ///< rows made as correct matches, ascending (another one may be correct by chance)
};

/// Source points uniform in a cube; a correct match goes to the moved point plus normal noise, with the moved frame, an
/// incorrect one to a uniform point of the moved cube, with a random frame. Feature distances of correct matches are smaller
/// and more distinctive. Correct matches are spread over the rows at random.
/// Throws InvalidInput if an option is out of range.
SyntheticProblem make_synthetic_problem(const SyntheticOptions& options);

}  // namespace corral
