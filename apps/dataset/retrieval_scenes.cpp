// SPDX-License-Identifier: MIT
#include "apps/dataset/retrieval_scenes.h"

#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

constexpr int kLevels = 9;  // of each nuisance
constexpr int kFewestVertices = 100;

struct Level {
  std::string noise_pr = "0", density = "1";

  std::string name() const { return density == "1" ? "noise" + noise_pr : "density" + density; }
};

Level level_of(int i) {
  Level level;
  if (i < kLevels)
    level.noise_pr = to_text((i + 1) * 5 / 100.0);  // 0.05 .. 0.45
  else
    level.density = to_text((2 * kLevels - i) / 10.0);  // 0.9 .. 0.1
  return level;
}

Mesh perturbed(const Mesh& clean, const Level& level, double resolution, std::uint64_t seed) {
  if (level.density == "1") return add_gaussian_noise(clean, parse_double(level.noise_pr).value() * resolution, seed);
  return thin_mesh(clean, parse_double(level.density).value(), seed);
}

}  // namespace

const std::vector<std::string>& retrieval_attributes() {
  static const std::vector<std::string> names = {"model", "scene", "noise_pr", "density"};
  return names;
}

std::vector<DatasetPair> make_retrieval_pairs(const SetFolder& folder, const RetrievalScene& scene, const Mesh& model,
                                              std::uint64_t seed, const ParallelFor& parallel) {
  if (model.vertices.rows() < kFewestVertices)
    throw IoError(folder.path(scene.model_file), "",
                  "has " + std::to_string(model.vertices.rows()) + " vertices, expected at least " +
                      std::to_string(kFewestVertices) + " so that a tenth of them is a surface");
  const std::string truth = "truth/" + scene.name + ".xf";
  if (!folder.has(truth)) folder.put(truth, transform_text(scene.scene_from_model));
  const Mesh clean = move_mesh(model, scene.scene_from_model);
  const double resolution = point_resolution(model.vertices, parallel);
  std::vector<DatasetPair> pairs(2 * kLevels);
  parallel(2 * kLevels, [&](int i) {
    const Level level = level_of(i);
    const std::string name = scene.name + "_" + level.name(), file = "scenes/" + name + ".ply";
    if (!folder.has(file))
      folder.put(file, binary_ply_text(perturbed(clean, level, resolution, derive_seed(seed, name))));
    pairs[static_cast<std::size_t>(i)] = {
        name, scene.model_file, file, truth, {scene.model, scene.name, level.noise_pr, level.density}};
  });
  return pairs;
}

}  // namespace corral
