// SPDX-License-Identifier: MIT
#include "grouping/similarity_score.h"

namespace corral {

GroupingResult group_by_similarity_score(const CorrespondenceSet& matches, const SimilarityScoreOptions& options) {
  require_columns(matches, "ss", {Column::FeatureDistance});
  GroupingResult result;
  result.scores.resize(static_cast<std::size_t>(matches.size()));
  for (int row = 0; row < matches.size(); ++row)
    result.scores[static_cast<std::size_t>(row)] = 1 - matches.feature_distance(row);
  result.selected = select_by_otsu(result.scores, options.otsu);
  return result;
}

double working_memory(int matches, const SimilarityScoreOptions& options) {
  return 8.0 * matches + otsu_memory(matches, options.otsu);
}

}  // namespace corral
