// SPDX-License-Identifier: MIT
#pragma once

#include "io/matches/feature_file.h"
#include "kernel/correspondence_set.h"
#include "kernel/surface/feature_matching.h"

namespace corral {

/// The matches of two sets of keypoints whose features another program has computed, by match_features: a row per source
/// keypoint, or per pair of mutually nearest ones. Keypoint columns where both sides name vertices. Resolution 1.
/// Throws    InvalidInput for features of different lengths.
CorrespondenceSet match_feature_points(const FeaturePoints& source, const FeaturePoints& target,
                                       const MatchingOptions& options, const ParallelFor& parallel);

}  // namespace corral
