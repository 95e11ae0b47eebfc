// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct MakeChallengeOptions {
  std::string tables;  ///< folder of a data set whose pairs have tables of matches and truths
  std::string output;  ///< folder of the new set
  std::vector<int> sizes = {1000};
  std::vector<double> inlier_ratios = {0.5, 1, 2, 5, 10, 20, 50};  ///< percent
  std::vector<double> noises_pr = {0};
  int repeats = 1;  ///< tables of each kind out of each real one
  double threshold_pr = 4;
  std::uint64_t seed = 1;
  ParallelFor parallel = one_by_one;
};

/// How many tables there will be. Throws as read_dataset.
int count_challenge(const MakeChallengeOptions& options);

/// A set of tables of chosen sizes and shares of correct matches out of real ones (draw_challenge), named "challenge", with the
/// attributes table, size, ratio, noise_pr and repeat. One progress step per table. An interrupted call continues when repeated.
/// Throws IoError (a pair without a table or a truth, files), InvalidInput.
void make_challenge(const MakeChallengeOptions& options, Progress& progress);

}  // namespace corral
