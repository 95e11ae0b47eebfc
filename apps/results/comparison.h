// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/results/level_table.h"
#include "apps/results/statistics.h"

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

/// The mean of a method at a level, over all pairs that count there; absent without any. Deterministic: its interval
/// depends on the numbers and on the names of experiment, level and method.
std::optional<MeanInterval> level_mean(const std::string& experiment, const LevelTable& level,
                                       const std::string& method, const Measure& measure);

/// A method at a level.
struct LevelMean {
  std::string level, method;
  int pairs = 0;
  MeanInterval mean;
};

/// The comparison of the groupers of an experiment.
struct MethodComparison {
  std::string experiment;
  std::vector<std::string> methods;  ///< those with numbers, in the experiment's order; the bounds left out
  int pairs = 0;                     ///< with a number of every method
  std::vector<MeanInterval> means;   ///< of each method
  RankComparison ranks;
  std::vector<MethodPair> tests;
  std::vector<LevelMean> levels;  ///< level by level, over all pairs that count
};

/// Compares on the pairs that count, over all levels; a pair that occurs at several levels is one, by the mean of its numbers.
/// Deterministic. Nothing but the levels is filled with fewer than 2 methods or without a common pair.
MethodComparison compare_methods(const ExperimentTable& table, const Measure& measure);

}  // namespace corral
