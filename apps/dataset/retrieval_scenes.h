// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/dataset/set_folder.h"
#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A moved copy of a model, from which 18 scenes are made.
struct RetrievalScene {
  std::string name;        ///< the names of its pairs begin with it
  std::string model;       ///< name of the model
  std::string model_file;  ///< as written to pairs.csv
  RigidTransform scene_from_model;
};

/// The columns of pairs.csv that they fill.
const std::vector<std::string>& retrieval_attributes();

/// Writes a scene at the 9 levels of noise (normal, 0.05 .. 0.45 pr on every coordinate) and the 9 levels of density (a
/// random subset of 0.9 .. 0.1 of the vertices, without noise), each from a seed of its own, and the truth. pr is that of
/// the clean model. Existing files stay. Returns the pairs.
///
/// Throws    IoError for a model of fewer than 100 vertices.
/// Source    [yang2017evaluation] for the levels; it does not say how the density was lowered.
std::vector<DatasetPair> make_retrieval_pairs(const SetFolder& folder, const RetrievalScene& scene, const Mesh& model,
                                              std::uint64_t seed, const ParallelFor& parallel);

}  // namespace corral
