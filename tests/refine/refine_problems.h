// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>

#include "kernel/synthetic.h"

namespace corral::testing {

inline Indices all_rows(const CorrespondenceSet& matches) {
  Indices rows(static_cast<std::size_t>(matches.size()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

inline SyntheticProblem problem(int matches, double inlier_ratio, double noise_pr, std::uint64_t seed,
                                double resolution = 1) {
  SyntheticOptions options;
  options.matches = matches;
  options.inlier_ratio = inlier_ratio;
  options.noise_pr = noise_pr;
  options.seed = seed;
  options.resolution = resolution;
  return make_synthetic_problem(options);
}

}  // namespace corral::testing
