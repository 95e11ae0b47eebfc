// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct MakeB3rOptions {
  std::vector<std::string> models;  ///< mesh files
  std::string output;               ///< folder of the set
  std::uint64_t seed = 1;
  int scenes_per_model = 3;  ///< moved copies of each model, each at 18 levels; the published set has 18 of 6 models
  ParallelFor parallel = one_by_one;
};

/// A retrieval set after the published one: each model under random motions, at 9 levels of noise and 9 of density.
/// An interrupted call continues when repeated. One progress step per copy. Throws IoError, InvalidInput.
///
/// Source    [yang2017evaluation], [tombari2013performance].
void make_b3r(const MakeB3rOptions& options, Progress& progress);

}  // namespace corral
