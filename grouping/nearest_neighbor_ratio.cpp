// SPDX-License-Identifier: MIT
#include "grouping/nearest_neighbor_ratio.h"

#include "grouping/compatibility.h"

namespace corral {

GroupingResult group_by_nearest_neighbor_ratio(const CorrespondenceSet& matches,
                                               const NearestNeighborRatioOptions& options) {
  validate_options(options, "nnsr");
  require_columns(matches, "nnsr", {Column::FeatureDistance, Column::SecondFeatureDistance});
  GroupingResult result;
  result.scores = ratio_scores(matches);
  for (int row = 0; row < matches.size(); ++row) {
    const double d1 = matches.feature_distance(row), d2 = matches.second_feature_distance(row);
    const bool kept = options.ratio == RatioRule::Lowe
                          ? passes_ratio_test(d1, d2, options.threshold)
                          : d2 > 0 && result.scores[static_cast<std::size_t>(row)] >= options.threshold;
    if (kept) result.selected.push_back(row);
  }
  return result;
}

double working_memory(int matches, const NearestNeighborRatioOptions&) {
  return 24.0 * matches;  // the scores, and the selection as it grows
}

}  // namespace corral
