// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/results/study_folder.h"

namespace corral::testing {

/// The seven methods, in the order of the registry.
const std::vector<std::string>& all_methods();

/// What a method made of a pair.
struct Scores {
  double precision = 0, recall = 0;
  double f1() const { return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0; }
};

/// An experiment whose records a test makes up.
struct SimulatedExperiment {
  std::string name, dataset;
  std::vector<StudyLevel> levels;
  int pairs = 6;              ///< at each level
  bool same_pairs = false;    ///< at all levels
  double inlier_ratio = 0.2;  ///< of 1000 matches
  std::function<Scores(const std::string& method, const StudyLevel& level, int pair)> scores;
};

StudyLevel step(double value);
StudyLevel bin(double low, double high);  ///< "[low,high)"

/// Adds the experiment's levels and records, in the order of a work list.
void add_experiment(StudyFolder& run, const SimulatedExperiment& experiment);

/// Adds an experiment of times: one pair, `repeats` records a size.
void add_times(StudyFolder& run, const std::vector<double>& sizes,
               const std::function<double(const std::string& method, double size)>& time_ms);

/// All eight experiments with the paper's levels, noisy scores from the seed, and few pairs at each level.
StudyFolder simulated_study(std::uint64_t seed, int pairs = 12);

/// manifest.json of a run.
std::string manifest_text(const StudyFolder& run);

/// manifest.json, records.csv and files of selections, as corral evaluate leaves them.
void write_run(const StudyFolder& run);

}  // namespace corral::testing
