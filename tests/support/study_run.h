// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/study_folder.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral::testing {

/// A pair of a study at a level.
struct StudyCase {
  std::string level, name;
  Mesh source, target;
  RigidTransform truth;
};

/// Matches the pairs, lets the experiment's methods and the bounds loose on them, and writes the folder of that run:
/// meshes, manifest.json, records.csv, selections. A case without vertices is a pair that failed.
void put_run(const std::string& folder, const ExperimentInfo& experiment, const std::vector<StudyCase>& cases);

}  // namespace corral::testing
