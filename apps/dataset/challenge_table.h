// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// What a table drawn from a real one shall be like.
struct ChallengeOptions {
  int matches = 1000;        ///< rows
  double inlier_ratio = 10;  ///< percent of them that are correct: rounded to whole rows
  double noise_pr = 0;       ///< deviation of normal noise on every coordinate of a target point
  double threshold_pr = 4;   ///< residual up to which a match is correct
  std::uint64_t seed = 1;
};

/// A table of any size and share of correct matches out of a real one, rows in random order.
///
///   correct rows     drawn without repetition. When all have been drawn, they are drawn again: as a match beside the first, both
///                    points moved by the same random vector of at most 5 pr, so that the residual stays what it was
///   incorrect rows   drawn without repetition. When all have been drawn, they are paired anew: the source side (point, frame,
///                    keypoint, distances) of one incorrect row with the target side of another, so that end points stay those
///                    of real mistakes
///
/// Noise may move a match across the threshold: such a row is drawn anew, and the share is what was asked for.
/// Throws    InvalidInput: an option out of range; no correct row to draw from, or fewer than two incorrect ones.
CorrespondenceSet draw_challenge(const CorrespondenceSet& real, const RigidTransform& target_from_source,
                                 const ChallengeOptions& options);

}  // namespace corral
