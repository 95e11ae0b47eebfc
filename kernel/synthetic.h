// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// A random table of matches whose truth is known.
struct SyntheticOptions {
  int matches = 500;
  double inlier_ratio = 0.5;   ///< share of right matches, 0 .. 1; the count is rounded to the nearest
  double noise_pr = 0.5;       ///< deviation of each target coordinate of a right match
  double extent_pr = 200;      ///< side of the cube that holds the source points
  double frame_noise_deg = 3;  ///< angle by which the target frame of a right match is turned about a random axis
  double resolution = 1.0;     ///< mesh units per pr
  std::uint64_t seed = 1;
};

struct SyntheticProblem {
  CorrespondenceSet matches;  ///< every column filled
  RigidTransform truth;       ///< target_from_source
  Indices inliers;            ///< rows made as right matches, ascending (a wrong one may be right by chance)
};

/// Source points uniform in a cube; a right match goes to the moved point plus normal noise with a frame that moves along,
/// a wrong one to a uniform point of the moved cube with a random frame. Feature distances of right matches are smaller
/// and more distinctive. Right matches are spread over the rows at random.
/// Throws InvalidInput if an option is out of range.
SyntheticProblem make_synthetic_problem(const SyntheticOptions& options);

}  // namespace corral
