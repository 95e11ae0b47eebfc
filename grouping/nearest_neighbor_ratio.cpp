// SPDX-License-Identifier: MIT
#include "grouping/nearest_neighbor_ratio.h"

#include <algorithm>

#include "grouping/columns/compatibility.h"

namespace corral {

GroupingResult group_by_nearest_neighbor_ratio(const CorrespondenceSet& matches,
                                               const NearestNeighborRatioOptions& options) {
  validate_options(options, "nnsr");
  require_columns(matches, "nnsr", {Column::FeatureDistance, Column::SecondFeatureDistance});
  GroupingResult result;
  const std::vector<double> ratios = feature_ratios(matches);
  result.scores = ratio_scores(ratios);
  std::vector<std::uint8_t> kept(ratios.size());
  if (options.ratio == RatioRule::Lowe)
    std::transform(ratios.begin(), ratios.end(), kept.begin(),
                   [limit = options.threshold](double ratio) { return ratio <= limit; });
  else
    std::transform(
        ratios.begin(), ratios.end(), result.scores.begin(), kept.begin(),
        [limit = options.threshold](double ratio, double score) { return ratio == ratio && score >= limit; });
  result.selected = marked_rows(kept);
  return result;
}

double working_memory(int matches, const NearestNeighborRatioOptions&) {
  return 24.0 * matches;  // the scores, and the selection as it grows
}

}  // namespace corral
