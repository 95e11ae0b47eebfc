// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"

namespace corral {

/// Where the alignment of a pair was won or lost. A pair is registered as is_registered says.
enum class Cause {
  Found,                ///< the fit to the selection registers the pair, and so does the refined pose
  Saved,                ///< the fit does not, but the refined pose does
  TooFewKeypoints,      ///< lost before the grouping: hardly any keypoint of the source lies in the overlap
  TooFewTrueMatches,    ///< lost before the grouping: not even all right matches together register the pair
  GrouperMissed,        ///< all right matches would; the selection holds fewer than 3 of them, or too much else
  DegenerateSelection,  ///< the selection lies on one line or in one place
  Diverged,             ///< the optimiser ended without a pose
  NotConverged,         ///< the optimiser was stopped while the pose was still moving
  Spoiled,              ///< the optimiser came to rest, but left a fit that registers the pair
  NoAnswer,             ///< the method failed, or would have needed too much memory
};

/// "found", "saved", "too few keypoints", "too few true matches", "grouper missed", "degenerate selection", "diverged",
/// "not converged", "spoiled", "no answer".
const char* to_text(Cause cause);

/// How many of the source's keypoints have a match, of these how many have a true image in the overlap, and how many of the
/// matches are right within the threshold.
struct PairCounts {
  int keypoints = 0, keypoints_in_overlap = 0, true_matches = 0;
  double threshold_pr = 4;
};

struct Explanation {
  std::string method;  ///< "pair" for what the oracle's pose says of the pair
  Cause cause;
  std::string text;  ///< a sentence or two, with the numbers and limits that decided
};

/// The pair first, then each method. `oracle`: the record of all right matches. All records are judged, or have a failure.
///
/// With a pair that the oracle does not register, too few keypoints are to blame if fewer than 20 lie in the overlap: at 15 %
/// right matches, which partial views reach, 3 cannot be expected of them. A method that fails where the oracle does not
/// is to blame itself if less than half of its selection is right; else its refinement is, where it did not come to rest.
std::vector<Explanation> explain_pair(const PairCounts& counts, const MethodRecord& oracle,
                                      const std::vector<MethodRecord>& records);

}  // namespace corral
