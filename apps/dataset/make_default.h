// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct MakeDefaultOptions {
  std::string meshes;  ///< folder of the meshes that data/default.toml names
  std::string scenes;  ///< folder of the real scenes and their model; empty: without them
  std::string output;  ///< folder of the sets b3r, u3or, u3or-real and u3m
  std::uint64_t seed = 1;
  ParallelFor parallel = one_by_one;
};

/// The number of progress steps.
double default_steps(const MakeDefaultOptions& options);

/// All sets of the study from meshes in Debian packages, as data/default.toml specifies, each in a folder of its own. Throws
/// IoError naming a mesh that does not exist.
void make_default(const MakeDefaultOptions& options, Progress& progress);

}  // namespace corral
