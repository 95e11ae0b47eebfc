// SPDX-License-Identifier: MIT
#include "apps/reproduce/pair_form.h"

#include <filesystem>

#include "apps/dataset/set_folder.h"
#include "apps/pair/read_surface.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

std::string inverted_rule(const std::string& resolution) {
  return resolution == "source" ? "target" : resolution == "target" ? "source" : resolution;
}

void swap_sides(DatasetPair& pair, const SetFolder& folder) {
  std::swap(pair.source, pair.target);
  int number = 0;
  const auto inverted = [&](const std::string& truth) {
    const std::string file = "truth/" + pair.name + (number == 0 ? "" : "-" + std::to_string(number)) + ".xf";
    ++number;
    if (!folder.has(file)) folder.put(file, transform_text(RigidTransform(read_transform(truth)).inverse()));
    return file;
  };
  if (!pair.truth.empty()) pair.truth = inverted(pair.truth);
  for (std::string& truth : pair.equal_truths) truth = inverted(truth);
}

void drop_faces(DatasetPair& pair, const SetFolder& folder) {
  const std::string file = "clouds/" + pair.name + ".ply";
  if (!folder.has(file)) {
    Mesh cloud;
    cloud.vertices = read_surface(pair.target).vertices;
    folder.put(file, binary_ply_text(cloud));
  }
  pair.target = file;
}

}  // namespace

std::string set_folder(const std::string& data, const std::string& set) {
  const bool is_set = fs::exists(fs::path(data) / "dataset.toml");
  return (is_set ? fs::path(data) : fs::path(data) / set).string();
}

void write_pair_form(const std::string& data, const std::string& set, PairForm form, const std::string& folder) {
  Dataset dataset = read_dataset(set_folder(data, set));
  const std::string word = choice_names(form)[static_cast<std::size_t>(form)];
  const SetFolder made((fs::path(folder) / set).string(), word + " form of " + absolute(dataset.folder) + "\n" +
                                                              checksum(dataset.path("pairs.csv")) + "\n");
  for (DatasetPair& pair : dataset.pairs) {
    if (!pair.has_surfaces()) continue;
    pair = dataset.with_paths(pair);
    for (std::string* file : {&pair.source, &pair.target, &pair.truth}) *file = absolute(*file);
    for (std::string& truth : pair.equal_truths) truth = absolute(truth);
    if (form == PairForm::Swapped) swap_sides(pair, made);
    if (form == PairForm::Cloud) drop_faces(pair, made);
  }
  if (form == PairForm::Swapped) dataset.resolution = inverted_rule(dataset.resolution);
  dataset.folder = (fs::path(folder) / set).string();
  if (!fs::exists(fs::path(dataset.folder) / "dataset.toml")) made.finish(dataset);
}

}  // namespace corral
