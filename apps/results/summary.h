// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/results/level_table.h"
#include "apps/results/statistics.h"

namespace corral {

/// One method at one level of one experiment, as its LevelTable has it.
///
/// A pair without a truth, or with fewer right matches than the experiment asks for, is excluded for all methods. Means are
/// unweighted over the pairs that stay (a pair that gave several tables counts with each); repeats count as one, by their
/// mean. An empty selection has precision 0 and recall 0, and so has a method that failed on a pair. A pair that could not
/// be matched at all is left out of the means.
struct SummaryRow {
  std::string experiment, dataset, level, method;
  int pairs = 0;     ///< that the means are over
  int excluded = 0;  ///< without (enough) right matches, or without a truth
  int empty = 0;     ///< of `pairs`, those where nothing was selected (in any repeat)
  int failed = 0;    ///< pairs that could not be matched, or on which the method gave no answer (in any repeat)
  std::optional<MeanInterval> precision, recall, f1;      ///< over pairs; F1 is taken per pair
  std::optional<MeanInterval> success;                    ///< share of pairs whose refined mean error is at most 5 pr
  std::optional<double> pooled_precision, pooled_recall;  ///< of all matches of all pairs together
  std::optional<double> precision_nonempty;               ///< mean over selections that are not empty
  std::optional<double> inlier_ratio;                     ///< mean share of right matches
  std::optional<double> frame_share;                      ///< mean over pairs that have frames
  std::optional<double> rotation_error_deg, translation_error_pr,
      mean_error_pr;                                     ///< medians, refined; no pose is infinite: empty
  std::optional<double> success_area;                    ///< under the curve of refined mean errors, 0 .. 5 pr
  std::optional<double> initial_success, dense_success;  ///< the same share for the other poses
};

/// Every level and method of every experiment (bounds behind the methods), in their order; pairs = 0 where nothing was.
std::vector<SummaryRow> summarize(const std::vector<ExperimentTable>& tables);

/// As the file summary.csv.
std::string summary_text(const std::vector<SummaryRow>& rows);

}  // namespace corral
