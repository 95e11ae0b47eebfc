// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/results/level_table.h"
#include "kernel/parallel.h"

namespace corral {

/// What stands for a level: a mean with its interval, or a number without one.
struct SummaryValue {
  std::optional<double> value, low, high;
};

/// One grouper at one level of one experiment, from its LevelTable.
///
/// A pair without a truth, or with fewer correct matches than the experiment requires, is excluded for all groupers. Means are
/// unweighted over the remaining pairs (a pair that gave several tables counts with each); repeats count as one, by their
/// mean. An empty selection has precision 0 and recall 0, and so has a grouper that failed on a pair. A pair that could not
/// be matched at all is left out of the means.
struct SummaryRow {
  std::string experiment, dataset, level, method;
  int pairs = 0;     ///< that the means are over
  int excluded = 0;  ///< with too few correct matches, or without a truth
  int misfit = 0;    ///< whose truth does not fit: left out for all groupers like excluded ones
  int empty = 0;     ///< of `pairs`, those where nothing was selected (in any repeat)
  int failed = 0;    ///< pairs that could not be matched, or on which the grouper gave no answer (in any repeat)
  std::map<std::string, SummaryValue> values;  ///< by the name of the measure; nothing where no row has the method

  SummaryValue of(const std::string& measure) const;
};

/// A column of summary.csv behind the names: a count or a value.
struct SummaryCell {
  std::string name;
  std::optional<int> count;
  std::optional<double> value;
};
std::vector<SummaryCell> summary_cells(const SummaryRow& row);

/// Every level and method of every experiment (bounds behind the methods), in their order; pairs = 0 where nothing was.
std::vector<SummaryRow> summarize(const std::vector<ExperimentTable>& tables,
                                  const ParallelFor& parallel_for = one_by_one);

/// As the file summary.csv.
std::string summary_text(const std::vector<SummaryRow>& rows);

}  // namespace corral
