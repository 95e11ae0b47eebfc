// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"

namespace corral {

/// Where a pair was registered or lost, in the sense of is_registered.
enum class Cause {
  Found,                ///< the fit to the selection registers the pair, and so does the refined pose
  Saved,                ///< the fit does not, but the refined pose does
  TruthDoesNotFit,      ///< the truth cannot belong to the pair: nothing that is judged by it means anything
  NormalsOpposed,       ///< lost before the grouping: the normals of one surface point to the other side
  TooFewKeypoints,      ///< lost before the grouping: hardly any keypoint of the source lies in the overlap
  TooFewTrueMatches,    ///< lost before the grouping: not even all correct matches together register the pair
  GrouperMissed,        ///< all correct matches would; the selection holds fewer than 3 of them, or too many others
  DegenerateSelection,  ///< the selection lies on one line or at one point
  Diverged,             ///< the refinement ended without a pose
  NotConverged,         ///< the refinement was stopped before it converged
  Spoiled,              ///< the fit registers the pair, the converged refinement does not
  NoAnswer,             ///< the grouper failed, or would have needed too much memory
};

/// "found", "saved", "truth does not fit", "normals opposed", "too few keypoints", "too few true matches", "grouper
/// missed", "degenerate selection", "diverged",
/// "not converged", "spoiled", "no answer".
const char* to_text(Cause cause);

/// What the cause depends on, of a grouper or of the oracle on a pair.
struct PairEnd {
  bool is_registered_at_first = false;  ///< by the fit to the selection
  bool is_registered = false;           ///< by the refined pose
  MethodState state = MethodState::Unknown;
  int correct = 0;       ///< of the selection
  double precision = 0;  ///< of the selection; 0 if it is empty
};
PairEnd end_of(const MethodRecord& record);

/// Of the pair itself, as the oracle ends on it. Keypoints are absent where a table of matches was given, opposed normals where
/// nobody looked.
struct PairState {
  bool fits = true;  ///< the truth may belong to the pair
  bool is_registered_by_oracle = false;
  bool has_opposed_normals = false;
  std::optional<int> keypoints_in_overlap = {};
};

/// The causes that explain_pair gives, by its rules.
Cause cause_of(const PairState& pair);
Cause cause_of(const PairEnd& method, Cause pair);

/// How many of the matches start from a point in the overlap. The keypoints are vertices of the source.
int keypoints_in_overlap(const CorrespondenceSet& matches, const PairTruth& truth);

/// The number of source keypoints with a match, of those in the overlap, and of the matches that are correct within the
/// threshold.
struct PairCounts {
  int keypoints = 0, keypoints_in_overlap = 0, true_matches = 0;
  double threshold_pr = 4;
  std::string misfit = {};                         ///< why the truth cannot belong to the pair; empty if it may
  std::optional<double> opposed_share = {};        ///< of the overlap, where the normals point to opposite sides
  std::string source_side = {}, target_side = {};  ///< what the normals follow, in words
};

struct Explanation {
  std::string method;  ///< "pair" for the pair itself, judged by the oracle
  Cause cause;
  std::string text;  ///< one or two sentences, with the deciding numbers and limits
};

/// The pair first, then each grouper. `oracle`: the record of all correct matches. All records are judged, or have a failure.
///
/// A truth that does not fit comes first. If the oracle does not register the pair, the cause are normals that are opposed on
/// most of the overlap; else too few keypoints if fewer than 20 lie in the overlap: at 15 %
/// correct matches, which partial views reach, fewer than 3 can be expected. If only the grouper fails, the cause is the
/// grouper if less than half of its selection is correct; else the refinement, if it did not converge.
std::vector<Explanation> explain_pair(const PairCounts& counts, const MethodRecord& oracle,
                                      const std::vector<MethodRecord>& records);

}  // namespace corral
