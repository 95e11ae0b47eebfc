// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/dataset/pair_sweep.h"

namespace corral {

/// The measures of a pair, in percent; absent where a file is missing, the truth is not known, or a mesh has no faces.
struct PairMeasures {
  std::optional<double> overlap;              ///< overlap_share within 2 pr
  std::optional<double> occlusion, clutter;   ///< by shared areas within 2 pr, the source as the model
  std::optional<double> inlier_ratio;         ///< share of correct matches (4 pr)
  std::optional<double> frame_repeatability;  ///< share of these whose frames agree within 10 degrees
};

/// The names of the five, as columns of pairs.csv, and a measure by its position among them.
const std::vector<std::string>& measure_names();
std::optional<double> measure(const PairMeasures& measures, std::size_t place);

/// The first three of one pair.
PairMeasures measure_pair(const Dataset& dataset, const SweptPair& pair);

/// All pairs in their order; `with_matches`: the last two as well, by matching every pair as in the paper.
std::vector<PairMeasures> measure_dataset(const Dataset& dataset, bool with_matches, const ParallelFor& parallel,
                                          Progress& progress);

/// One line per ten percent: the number of values and a bar; then the median of all. Empty if there are none.
std::string histogram_text(const std::string& name, const std::vector<double>& percent);

/// The number of values in each of the ten bins [0,10) .. [90,100].
std::vector<int> histogram(const std::vector<double>& percent);

}  // namespace corral
