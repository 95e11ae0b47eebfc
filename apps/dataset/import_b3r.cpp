// SPDX-License-Identifier: MIT
#include "apps/dataset/import_b3r.h"

#include <filesystem>
#include <optional>

#include "apps/dataset/retrieval_scenes.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// A scene of the published set, as far as its files exist.
struct PublishedScene {
  std::string name;
  std::string model_file;  // absolute
  RigidTransform scene_from_model;
};

/// The value of MODEL_0 in a scene's configuration: the model's path on its publishers' machine.
std::string model_path(const std::string& path) {
  const std::string text = read_file(path);
  LineReader reader(path, text);
  while (reader.next()) {
    const auto& sides = reader.fields('=');
    if (sides.size() != 2 || fs::path(sides[0]).string().rfind("MODEL_0", 0) != 0) continue;
    if (sides[0].substr(0, sides[0].find_last_not_of(" \t") + 1) != "MODEL_0") continue;
    const std::string_view value = sides[1];
    const auto begin = value.find('"'), end = value.rfind('"');
    if (begin == std::string_view::npos || end <= begin) reader.fail("expected MODEL_0 = \"path of the model\"");
    return std::string(value.substr(begin + 1, end - begin - 1));
  }
  throw IoError(path, "", "no line MODEL_0, expected one that names the model");
}

/// The file of a model that may carry a suffix: bun_zipper is bun_zipper.ply or bun_zipper_0.ply.
std::optional<std::string> find_model(const std::vector<std::string>& files, const std::string& stem) {
  for (const std::string& file : files) {
    const std::string other = fs::path(file).stem().string();
    if (other == stem || other.rfind(stem + "_", 0) == 0) return file;
  }
  return std::nullopt;
}

/// The scenes that exist, and a line for each that does not.
std::vector<PublishedScene> find_scenes(const std::string& folder, std::vector<std::string>& missing) {
  const std::vector<std::string> models = mesh_files((fs::path(folder) / "models").string());
  std::vector<PublishedScene> scenes;
  for (int number = 0; number < kB3rScenes; ++number) {
    const std::string name = "Scene" + std::to_string(number);
    const fs::path truths = fs::path(folder) / "gt";
    const std::string config = (truths / ("Config" + name + ".ini")).string(),
                      truth = (truths / (name + "-rs0.xf")).string();
    const bool has_config = fs::exists(config);
    if (!has_config || !fs::exists(truth)) {
      missing.push_back(name + ": no gt/" + fs::path(has_config ? truth : config).filename().string());
      continue;
    }
    const std::string stem = fs::path(model_path(config)).stem().string();
    const auto model = find_model(models, stem);
    if (!model) {
      missing.push_back(name + ": no model " + stem);
      continue;
    }
    scenes.push_back({name, fs::absolute(*model).lexically_normal().string(), read_transform(truth)});
  }
  return scenes;
}

/// The stored scenes SceneK_S.ply as pairs, with S and the noise that is measured.
std::vector<DatasetPair> stored_pairs(const SetFolder& folder, const PublishedScene& scene, const Mesh& model,
                                      const std::string& scenes, std::vector<std::string>& missing) {
  const std::string truth = "truth/" + scene.name + ".xf";
  folder.put(truth, transform_text(scene.scene_from_model));
  const Mesh clean = move_mesh(model, scene.scene_from_model);
  const double resolution = point_resolution(model.vertices);
  std::vector<DatasetPair> pairs;
  for (const char* level : {"0.1", "0.3", "0.5"}) {
    const std::string name = scene.name + "_" + level;
    const fs::path file = fs::absolute(fs::path(scenes) / (name + ".ply")).lexically_normal();
    if (!fs::exists(file)) {
      missing.push_back(name + ": no scenes/" + name + ".ply");
      continue;
    }
    const Mesh noisy = read_mesh(file.string());
    if (noisy.vertices.rows() != clean.vertices.rows())
      throw IoError(file.string(), "",
                    "has " + std::to_string(noisy.vertices.rows()) + " vertices, expected the " +
                        std::to_string(clean.vertices.rows()) + " of its model");
    pairs.push_back(
        {name,
         scene.model_file,
         file.string(),
         truth,
         {file_word(scene.model_file), scene.name, to_text(noise_deviation(clean, noisy) / resolution), "1", level}});
  }
  return pairs;
}

Dataset empty_set(bool stored) {
  Dataset dataset;
  dataset.name = stored ? "b3r-stored" : "b3r";
  dataset.kind = "retrieval";
  dataset.units = "m";
  dataset.resolution = "source";
  dataset.provenance = "Bologna 3D retrieval set, Stanford models; ";
  dataset.provenance += stored ? "scenes as published" : "noise and density levels made from its models and truths";
  dataset.licence = "research; models: the terms of the Stanford 3D scanning repository";
  dataset.citation = {"Tombari, Salti, Di Stefano: Performance Evaluation of 3D Keypoint Detectors, IJCV 2013"};
  dataset.attributes = retrieval_attributes();
  if (stored) dataset.attributes.emplace_back("stated_noise_edges");
  return dataset;
}

}  // namespace

std::vector<std::string> import_b3r(const ImportB3rOptions& options, Progress& progress) {
  std::vector<std::string> missing;
  const std::vector<PublishedScene> scenes = find_scenes(options.folder, missing);
  const SetFolder folder(
      options.output, "import b3r\nfolder " + fs::absolute(options.folder).lexically_normal().string() + "\nlevels " +
                          (options.stored ? "stored" : "study") + "\nseed " + std::to_string(options.seed) + "\n");
  Dataset dataset = empty_set(options.stored);
  for (const PublishedScene& scene : scenes) {
    progress.begin(scene.name);
    const Mesh model = read_mesh(scene.model_file);
    const auto pairs =
        options.stored
            ? stored_pairs(folder, scene, model, (fs::path(options.folder) / "scenes").string(), missing)
            : make_retrieval_pairs(folder,
                                   {scene.name, file_word(scene.model_file), scene.model_file, scene.scene_from_model},
                                   model, options.seed, options.parallel);
    dataset.pairs.insert(dataset.pairs.end(), pairs.begin(), pairs.end());
  }
  if (dataset.pairs.empty())
    throw IoError(options.folder, "", "no scene with its model and truth, expected models/, scenes/ and gt/");
  folder.finish(dataset);
  return missing;
}

}  // namespace corral
