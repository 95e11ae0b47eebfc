// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/dataset/set_folder.h"
#include "apps/runtime/progress.h"
#include "kernel/parallel.h"

namespace corral {

/// A model in a scene as published.
struct PublishedInstance {
  std::string model, scene;            ///< names
  std::string model_file, scene_file;  ///< meshes; used where they are
  std::string truth;                   ///< scene_from_model as the text of a transform file
  std::string occlusion;               ///< percent, as published
};

/// The columns of pairs.csv that they fill, all in percent: occlusion as published; clutter from
///
///   clutter = 1 - (1 - occlusion) A_model / A_scene     A: area of all triangles
///
/// and both as measured from the surfaces that are there (shared_area within 2 pr).
const std::vector<std::string>& recognition_attributes();

/// Adds the instances to the set as pairs MODEL-SCENE and writes their truths. Throws IoError if a mesh cannot be read.
void add_recognition_pairs(const std::vector<PublishedInstance>& instances, const SetFolder& folder, Dataset& dataset,
                           const ParallelFor& parallel, Progress& progress);

/// A set without pairs, with provenance, licence and citations of the published set.
Dataset uwa_recognition_set(const std::string& name);

}  // namespace corral
