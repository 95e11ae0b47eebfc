// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/results/bootstrap.h"
#include "apps/results/level_table.h"
#include "apps/results/statistics.h"
#include "kernel/parallel.h"

namespace corral {

/// What methods are compared by: the words of the headline measures, in alphabetic order.
std::vector<std::string> metric_names();
const Measure& metric_of(const std::string& name);  ///< throws InvalidInput

/// Two groupers on the same pairs.
struct MethodPair {
  std::string first, second;
  MeanInterval difference;  ///< first - second
  double p = 1;             ///< Wilcoxon's signed-rank test; of successes McNemar's exact one
  double adjusted_p = 1;    ///< Holm's, among all pairs of methods of the experiment
  bool is_exact = true;     ///< not by the normal approximation
};

/// The means of a method at a level, over all pairs that count there, for each measure; absent without any. Deterministic:
/// an interval depends on the numbers and on the names of experiment, level and method.
std::vector<std::optional<MeanInterval>> level_means(const std::string& experiment, const LevelTable& level,
                                                     const std::string& method,
                                                     const std::vector<const Measure*>& measures);

/// A method at a level.
struct LevelMean {
  std::string level, method;
  int pairs = 0;
  MeanInterval mean;
};

/// The groupers of an experiment, ranked on the pairs that all of them have numbers of.
struct MethodRanks {
  std::string experiment;
  std::vector<std::string> methods;  ///< those with numbers, in the experiment's order; the bounds left out
  int pairs = 0;                     ///< with a number of every method
  RankComparison ranks;
};

/// The comparison of the groupers of an experiment.
struct MethodComparison : MethodRanks {
  std::vector<MeanInterval> means;  ///< of each method
  std::vector<MethodPair> tests;
  std::vector<LevelMean> levels;  ///< level by level, over all pairs that count
};

/// Compares on the pairs that count, over all levels; a pair that occurs at several levels is one, by the mean of its numbers.
/// Deterministic. Nothing but the levels is filled with fewer than 2 methods or without a common pair.
MethodComparison compare_methods(const ExperimentTable& table, const Measure& measure,
                                 const ParallelFor& parallel_for = one_by_one);
/// The ranks alone, which take no resamples.
MethodRanks rank_methods(const ExperimentTable& table, const Measure& measure);

}  // namespace corral
