// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/results/study_folder.h"

namespace corral {

/// A matched pair: the records of one file of selections.
struct SceneChoice {
  int run = 0;
  std::string dataset, pair, selection;
};

/// At most `most` scenes: of every level of every experiment the one of median mean F1, then the worst, then the best,
/// then the others. Pairs without a file of selections are left out.
std::vector<SceneChoice> choose_scenes(const std::vector<StudyFolder>& runs, int most);

/// Surfaces and matches of the chosen, as JSON {meshes, scenes}. Coordinates are 16 bit of the box of their mesh, in
/// base64.
///   meshes  {low, high, vertices, triangles, normals, full: vertices before they were clustered}
///   scenes  {run, dataset, pair, selection, source, target (numbers of meshes), resolution, matches, source_points,
///           target_points, residuals (floats, or null), truth, selected {method: bits},
///           poses {method: {stage: 12 numbers}}}, or {run, dataset, pair, selection, problem} for a file that cannot
///           be used
/// As many of them, from the first on, as take at most so many bytes.
nlohmann::ordered_json page_scenes(const std::vector<StudyFolder>& runs, const std::vector<SceneChoice>& choices,
                                   std::size_t most_bytes);

}  // namespace corral
