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
      false;  ///< true: the published scenes, with noise of S mean edge lengths; false: the 18 levels of the study, made
              ///< from the published models and truths
  std::uint64_t seed = 1;
  ParallelFor parallel = one_by_one;
};

constexpr int kB3rScenes = 18;  ///< published, numbered from 0

/// The published retrieval set [tombari2013performance], or the part of it that exists. Meshes stay where they are; pairs.csv
/// names them by absolute paths. The noise of stored scenes is measured from the vertices, which correspond to those of the
/// model in order. Throws IoError if no scene remains.
///
/// Returns   what is missing, one line each.
std::vector<std::string> import_b3r(const ImportB3rOptions& options, Progress& progress);

}  // namespace corral
