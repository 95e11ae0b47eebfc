// SPDX-License-Identifier: MIT
#include "apps/dataset/make_b3r.h"

#include <set>

#include "apps/dataset/retrieval_scenes.h"
#include "io/mesh/mesh_file.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"

namespace corral {
namespace {

/// The names of the models, each once. Two files of one name (pig.off, pig.stl) could not be told apart.
std::vector<std::string> model_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const std::string& file : files) {
    names.push_back(file_word(file));
    if (!seen.insert(names.back()).second)
      throw IoError(file, "", "is a second model named " + names.back() + ", expected each name once");
  }
  return names;
}

std::string recipe(const MakeB3rOptions& options, const std::vector<std::string>& names) {
  std::string text = "make b3r\nseed " + std::to_string(options.seed) + "\nscenes per model " +
                     std::to_string(options.scenes_per_model) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i) text += "model " + names[i] + " " + checksum(options.models[i]) + "\n";
  return text;
}

Dataset empty_set() {
  Dataset dataset;
  dataset.name = "b3r";
  dataset.kind = "retrieval";
  dataset.resolution = "source";
  dataset.provenance = "moved copies of meshes at 9 levels of noise and 9 of density, made by corral dataset make b3r";
  dataset.licence = "that of the meshes";
  dataset.attributes = retrieval_attributes();
  return dataset;
}

}  // namespace

void make_b3r(const MakeB3rOptions& options, Progress& progress) {
  const std::vector<std::string> names = model_names(options.models);
  const SetFolder folder(options.output, recipe(options, names));
  Dataset dataset = empty_set();
  for (std::size_t i = 0; i < names.size(); ++i) {
    Mesh model = read_mesh(options.models[i]);
    const std::string file = "models/" + names[i] + ".ply";
    if (!folder.has(file)) folder.put(file, binary_ply_text(model));
    for (int copy = 1; copy <= options.scenes_per_model; ++copy) {
      const std::string scene = names[i] + "-" + std::to_string(copy);
      progress.begin(scene);
      const RigidTransform motion = random_motion(model, derive_seed(options.seed, scene));
      const auto pairs =
          make_retrieval_pairs(folder, {scene, names[i], file, motion}, model, options.seed, options.parallel);
      dataset.pairs.insert(dataset.pairs.end(), pairs.begin(), pairs.end());
    }
  }
  folder.finish(dataset);
}

}  // namespace corral
