// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

struct ImportB3rOptions {
  std::string folder;  ///< models/*.ply, scenes/SceneK_S.ply, gt/SceneK-rs0.xf, gt/ConfigSceneK.ini
  std::string output;  ///< folder of the set
  bool stored =
      false;  ///< the scenes as they are, with noise of S mean edge lengths; false: the study's 18 levels, made from
              ///< the published models and truths
  std::uint64_t seed = 1;
  ParallelFor parallel = one_by_one;
};

constexpr int kB3rScenes = 18;  ///< published, numbered from 0

/// The published retrieval set [tombari2013performance], or the part of it that is there. Meshes stay where they are; pairs.csv
/// names them by absolute paths. Of stored scenes, the noise is measured from the vertices, which are those of the model in
/// their order. Throws IoError if no scene is left.
///
/// Returns   what is missing, one line each.
std::vector<std::string> import_b3r(const ImportB3rOptions& options, Progress& progress);

}  // namespace corral
