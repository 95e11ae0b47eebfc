// SPDX-License-Identifier: MIT
#include "apps/dataset/make_u3or.h"

#include <algorithm>
#include <cmath>

#include "apps/dataset/set_part.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

constexpr double kDiagonal = 200;        // of every model, mm: about as in the published set
constexpr double kMostOcclusion = 0.95;  // of a pair
constexpr double kPointsPerCell = 0.77;  // of a scene, for each cell of the mean area of the models; measured
constexpr double kLeastPoints = 20000, kMostPoints = 60000;  // of a scene, about

std::string recipe(const MakeU3orOptions& options, const std::vector<NamedMesh>& models) {
  return "make u3or\nseed " + std::to_string(options.seed) + "\nscenes " + std::to_string(options.scenes) +
         "\nnoise_pr " + to_text(options.noise_pr) + "\n" + recipe_lines(options.models, models);
}

Dataset empty_set() {
  Dataset dataset;
  dataset.name = "u3or";
  dataset.kind = "recognition";
  dataset.units = "mm";
  dataset.provenance =
      "heaps of meshes, each scaled to a diagonal of 200 mm, seen by a virtual range scanner; made by corral dataset "
      "make u3or";
  dataset.licence = "that of the meshes";
  dataset.attributes = {"scene", "model", "clutter", "occlusion"};
  return dataset;
}

Mesh at_common_size(Mesh mesh) {
  mesh.vertices.rowwise() -= vertex_centroid(mesh).transpose();
  const double diagonal = bounding_box(mesh.vertices).diagonal();
  if (diagonal > 0) mesh.vertices *= kDiagonal / diagonal;
  return mesh;
}

class RecognitionSet {
 public:
  RecognitionSet(const MakeU3orOptions& options, std::vector<NamedMesh> models)
      : options_(options), folder_(options.output, recipe(options, models)) {
    double resolution = 0, area = 0;
    for (NamedMesh& model : models) {
      names_.push_back(model.name);
      surfaces_.emplace_back(at_common_size(std::move(model.mesh)));
      const Mesh& mesh = surfaces_.back().mesh();
      if (!folder_.has(model_file(model.name))) folder_.put(model_file(model.name), binary_ply_text(mesh));
      resolution += point_resolution(mesh.vertices, options.parallel);
      area += surface_area(mesh);
    }
    const double count = static_cast<double>(models.size()), points = kPointsPerCell * area / count;
    spacing_ = std::clamp(resolution / count / kScanResolution, std::sqrt(points / kMostPoints),
                          std::sqrt(points / kLeastPoints));
  }

  VisibilityCounts make(Progress& progress) {
    progress.begin("composing", 2.0 * options_.scenes);
    compose_if_needed();
    Dataset dataset = empty_set();
    for (int scene = 0; scene < options_.scenes; ++scene) {
      progress.begin(scene_name(scene));
      const SetPart part(folder_, "scenes/" + scene_name(scene) + ".csv");
      if (!part.is_finished()) make_scene(part, scene, dataset.attributes);
      part.add_to(dataset);
    }
    VisibilityCounts counts;
    for (const DatasetPair& pair : dataset.pairs)
      counts.add(attribute_number(dataset, pair, "occlusion").value_or(0) / 100,
                 attribute_number(dataset, pair, "clutter").value_or(0) / 100);
    folder_.finish(dataset);
    return counts;
  }

 private:
  static std::string model_file(const std::string& name) { return "models/" + name + ".ply"; }
  static std::string scene_name(int scene) { return numbered('s', scene); }

  void compose_if_needed() {
    bool all = true;
    for (int scene = 0; scene < options_.scenes; ++scene)
      all = all && SetPart(folder_, "scenes/" + scene_name(scene) + ".csv").is_finished();
    if (all) return;
    for (const SurfaceTree& surface : surfaces_) pointers_.push_back(&surface);
    CompositionOptions options;
    options.scenes = options_.scenes;
    options.spacing = spacing_;
    options.seed = options_.seed;
    scenes_ = compose_scenes(pointers_, options, options_.parallel);
  }

  void make_scene(const SetPart& part, int number, const std::vector<std::string>& attributes) const {
    const ComposedScene& scene = scenes_[static_cast<std::size_t>(number)];
    const std::string name = scene_name(number), file = "scenes/" + name + ".ply";
    const PosedSurfaces posed = scene.posed(pointers_);
    RangeScanOptions options;
    options.spacing = spacing_;
    options.noise = options_.noise_pr * kScanResolution * spacing_;
    options.seed = derive_seed(options_.seed, "noise of " + name);
    const RangeScan scan = scan_range(posed, scene.sensor, options, options_.parallel);
    const std::vector<Visibility> shown = measure_visibility(posed, scan);
    std::vector<DatasetPair> pairs;
    for (std::size_t i = 0; i < posed.size(); ++i) {
      if (!(shown[i].occlusion <= kMostOcclusion)) continue;
      const std::string& model = names_[static_cast<std::size_t>(scene.objects[i])];
      const std::string pair = model + "-" + name, truth = "truth/" + pair + ".xf";
      part.put(truth, transform_text(scan.sensor_from_world * posed[i].world_from_mesh));
      pairs.push_back({pair,
                       model_file(model),
                       file,
                       truth,
                       {name, model, percent_text(shown[i].clutter), percent_text(shown[i].occlusion)}});
    }
    part.put(file, binary_ply_text(triangulated(scan)));
    part.finish(attributes, pairs);
  }

  const MakeU3orOptions& options_;
  SetFolder folder_;
  std::vector<std::string> names_;
  std::vector<SurfaceTree> surfaces_;
  std::vector<const SurfaceTree*> pointers_;
  double spacing_ = 0;
  std::vector<ComposedScene> scenes_;
};

std::string row_text(const std::string& what, const std::array<double, 7>& edges, const std::array<int, 6>& counts) {
  std::string text = what + " %, pairs:";
  for (std::size_t bin = 0; bin < counts.size(); ++bin)
    text += (bin > 0 ? ", " : " ") + to_text(edges[bin]) + "-" + to_text(edges[bin + 1]) + ": " +
            std::to_string(counts[bin]);
  return text + "\n";
}

}  // namespace

VisibilityCounts make_u3or(const MakeU3orOptions& options, Progress& progress) {
  if (options.scenes < 1) throw InvalidInput("make_u3or", "scenes", options.scenes, "at least 1");
  if (options.models.empty()) throw InvalidInput("make_u3or", "models", "none", "at least one, preferably 5 or more");
  require_noise("make_u3or", options.noise_pr);
  return RecognitionSet(options, read_models(options.models)).make(progress);
}

std::string to_text(const VisibilityCounts& counts) {
  return row_text("occlusion", VisibilityCounts::kOcclusion, counts.occlusion) +
         row_text("clutter", VisibilityCounts::kClutter, counts.clutter) +
         "outside the bins of one of the two: " + std::to_string(counts.outside);
}

}  // namespace corral
