// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

/// A line of occlusion.txt: a model in a scene, and the share of its surface that the scanner did not see.
struct OcclusionLine {
  int scene = 0;        ///< k of rs<k>
  std::string model;    ///< as in the names of the truths: chef, chicken, parasaurolophus, T-rex
  std::string percent;  ///< as written there; a number
};
/// Throws IoError naming file and line.
std::vector<OcclusionLine> read_occlusion_table(const std::string& path);

constexpr int kU3orPairs = 188;  ///< published

struct ImportU3orOptions {
  std::string folder;  ///< occlusion.txt, <model>-rs<k>.xf, models and scenes, anywhere below
  std::string output;  ///< folder of the set
  ParallelFor parallel = one_by_one;
};

/// The published recognition set [mian2006recognition] [mian2010repeatability], or the part of it that exists: the pairs of
/// occlusion.txt, 188 in the complete set. A model is the file whose name begins with its name, the one that ends in _high
/// or else the largest; a scene is rs<k> or rs<k>_something. Meshes stay where they are; pairs.csv names them by absolute
/// paths. Throws IoError if no pair remains.
///
/// Returns   what is missing and which of several models was chosen, one line each.
std::vector<std::string> import_u3or(const ImportU3orOptions& options, Progress& progress);

}  // namespace corral
