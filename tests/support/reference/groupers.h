// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "grouping/columns/otsu.h"
#include "grouping/geometric_consistency.h"
#include "grouping/hough_voting.h"
#include "grouping/nearest_neighbor_ratio.h"
#include "grouping/ransac.h"
#include "grouping/search_of_inliers.h"
#include "grouping/similarity_score.h"
#include "grouping/spectral.h"
#include "kernel/correspondence_set.h"

/// Every grouper once more, written straight from its definition: slow double loops, no shared code. An oracle for
/// tests; options are not validated and all columns must be there.
namespace corral::reference {

/// What a definition selects.
struct Selection {
  Indices rows;
  std::vector<double> scores = {};  ///< one per match where the definition scores them
  bool tied = false;                ///< which of several equals it is was settled by the order of rows or cells
};

Indices rows_by_otsu(const std::vector<double>& scores, OtsuRule rule);

Selection similarity_score(const CorrespondenceSet& matches, const SimilarityScoreOptions& options);
Selection nearest_neighbor_ratio(const CorrespondenceSet& matches, const NearestNeighborRatioOptions& options);
Selection spectral(const CorrespondenceSet& matches, const SpectralOptions& options);
Selection geometric_consistency(const CorrespondenceSet& matches, const GeometricConsistencyOptions& options);
Selection hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options);
Selection search_of_inliers(const CorrespondenceSet& matches, const SearchOfInliersOptions& options);

/// Draws the triples of the stream that the options name, so that the rows compare.
Selection ransac(const CorrespondenceSet& matches, const RansacOptions& options);

/// Rows in agreement with the best of `trials` random triples. Its draws are its own, so only the count compares.
int ransac_count(const CorrespondenceSet& matches, int trials, double tolerance_pr, std::uint64_t seed);

}  // namespace corral::reference
