// SPDX-License-Identifier: MIT
#include "apps/dataset/recognition_pairs.h"

#include <filesystem>

#include "apps/dataset/measure_dataset.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/scan/visibility.h"

namespace corral {
namespace {

std::string absolute(const std::string& path) { return std::filesystem::absolute(path).lexically_normal().string(); }

std::vector<std::string> measured_cells(const Dataset& dataset, const SweptPair& pair, double occlusion) {
  const PairMeasures measures = measure_pair(dataset, pair);
  const double scene_area = surface_area(pair.target.mesh);
  const double ratio = surface_area(pair.source.mesh) / scene_area;
  std::optional<double> clutter;
  if (scene_area > 0) clutter = 100 - (100 - occlusion) * ratio;
  return {fixed(clutter, 2), fixed(measures.occlusion, 2), fixed(measures.clutter, 2)};
}

}  // namespace

const std::vector<std::string>& recognition_attributes() {
  static const std::vector<std::string> names = {
      "model", "scene", "occlusion", "clutter", "measured_occlusion", "measured_clutter"};
  return names;
}

void add_recognition_pairs(const std::vector<PublishedInstance>& instances, const SetFolder& folder, Dataset& dataset,
                           const ParallelFor& parallel, Progress& progress) {
  std::vector<double> occlusions;
  for (const PublishedInstance& each : instances) {
    const std::string name = each.model + "-" + each.scene, truth = "truth/" + name + ".xf";
    folder.put(truth, each.truth);
    dataset.pairs.push_back(
        {name, absolute(each.model_file), absolute(each.scene_file), truth, {each.model, each.scene, each.occlusion}});
    occlusions.push_back(parse_double(each.occlusion).value());
  }
  sweep_pairs(dataset, parallel, progress, [&](int row, const SweptPair& pair) {
    const auto i = static_cast<std::size_t>(row);
    for (const auto& [file, surface] : {std::pair(pair.pair.source, &pair.source), {pair.pair.target, &pair.target}})
      if (!surface->problem.empty()) throw IoError(file, "", surface->problem);
    if (!pair.truth) throw IoError(dataset.path(pair.pair.truth), "", pair.truth_problem);
    for (const std::string& cell : measured_cells(dataset, pair, occlusions[i]))
      dataset.pairs[i].attributes.push_back(cell);
  });
}

Dataset uwa_recognition_set(const std::string& name) {
  Dataset dataset;
  dataset.name = name;
  dataset.kind = "recognition";
  dataset.units = "mm";
  dataset.provenance = "UWA 3D object recognition: models in scenes of a Minolta Vivid 910 scanner, published poses";
  dataset.licence = "research purposes only; cite both papers";
  dataset.citation = {
      "Mian, Bennamoun, Owens: Three-Dimensional Model-Based Object Recognition and Segmentation in Cluttered Scenes, "
      "PAMI 2006",
      "Mian, Bennamoun, Owens: On the Repeatability and Quality of Keypoints for Local Feature-based 3D Object "
      "Retrieval from Cluttered Scenes, IJCV 2010"};
  dataset.attributes = recognition_attributes();
  return dataset;
}

}  // namespace corral
