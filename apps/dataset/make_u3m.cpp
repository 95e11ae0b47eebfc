// SPDX-License-Identifier: MIT
#include "apps/dataset/make_u3m.h"

#include <algorithm>

#include "apps/dataset/set_part.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"
#include "kernel/surface/scan/range_scan.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

constexpr int kRing = 16;
constexpr double kLeastOverlap = 0.3, kMostOverlap = 0.9;

std::string recipe(const MakeU3mOptions& options, const std::vector<NamedMesh>& models) {
  return "make u3m\nseed " + std::to_string(options.seed) + "\nviews " + std::to_string(options.views) + "\nnoise_pr " +
         to_text(options.noise_pr) + "\n" + recipe_lines(options.models, models);
}

Dataset empty_set() {
  Dataset dataset;
  dataset.name = "u3m";
  dataset.kind = "registration";
  dataset.provenance = "meshes seen by a ring of virtual range scanners; made by corral dataset make u3m";
  dataset.licence = "that of the meshes";
  dataset.attributes = {"model", "source_view", "target_view", "overlap"};
  return dataset;
}

struct View {
  Points points;
  double resolution;
  RigidTransform sensor_from_world;
};

/// Scans the model from all sides and writes the views.
std::vector<View> make_views(const SetPart& part, const NamedMesh& model, const MakeU3mOptions& options) {
  const double spacing = point_resolution(model.mesh.vertices, options.parallel) / kScanResolution;
  const SurfaceTree surface(model.mesh);
  std::vector<View> views(static_cast<std::size_t>(options.views));
  options.parallel(options.views, [&](int i) {
    const std::string name = model.name + "-" + numbered('v', i);
    RangeScanOptions scan_options;
    scan_options.spacing = spacing;
    scan_options.noise = options.noise_pr * kScanResolution * spacing;
    scan_options.seed = derive_seed(options.seed, "noise of " + name);
    const RangeScan scan =
        scan_range({{&surface, {}}}, ring_sensor(model.mesh, i, std::max(options.views, kRing)), scan_options);
    part.put("views/" + name + ".ply", binary_ply_text(triangulated(scan)));
    views[static_cast<std::size_t>(i)] = {scan.points, point_resolution(scan.points), scan.sensor_from_world};
  });
  return views;
}

/// A pair of views of a model, and their overlap.
struct ViewPair {
  int source, target;
  double overlap;
  RigidTransform target_from_source;
};

std::vector<ViewPair> measure_pairs(const std::vector<View>& views, const ParallelFor& parallel) {
  std::vector<ViewPair> pairs;
  for (int source = 0; source < static_cast<int>(views.size()); ++source)
    for (int target = source + 1; target < static_cast<int>(views.size()); ++target)
      pairs.push_back({source, target, 0, {}});
  parallel(static_cast<int>(pairs.size()), [&](int i) {
    ViewPair& pair = pairs[static_cast<std::size_t>(i)];
    const View& source = views[static_cast<std::size_t>(pair.source)];
    const View& target = views[static_cast<std::size_t>(pair.target)];
    pair.target_from_source = target.sensor_from_world * source.sensor_from_world.inverse();
    pair.overlap = overlap_share(source.points, target.points, pair.target_from_source,
                                 kOverlapSharePr * (source.resolution + target.resolution) / 2);
  });
  return pairs;
}

void make_model(const SetPart& part, const NamedMesh& model, const MakeU3mOptions& options,
                const std::vector<std::string>& attributes) {
  std::vector<DatasetPair> pairs;
  for (const ViewPair& pair : measure_pairs(make_views(part, model, options), options.parallel)) {
    if (!(pair.overlap >= kLeastOverlap && pair.overlap <= kMostOverlap)) continue;
    const std::string source = numbered('v', pair.source), target = numbered('v', pair.target);
    const std::string name = model.name + "-" + source + "-" + target, truth = "truth/" + name + ".xf";
    part.put(truth, transform_text(pair.target_from_source));
    const auto file = [&](const std::string& view) { return "views/" + model.name + "-" + view + ".ply"; };
    pairs.push_back(
        {name, file(source), file(target), truth, {model.name, source, target, percent_text(pair.overlap)}});
  }
  part.finish(attributes, pairs);
}

}  // namespace

void make_u3m(const MakeU3mOptions& options, Progress& progress) {
  if (options.views < 2) throw InvalidInput("make_u3m", "views", options.views, "at least 2");
  require_noise("make_u3m", options.noise_pr);
  const std::vector<NamedMesh> models = read_models(options.models);
  const SetFolder folder(options.output, recipe(options, models));
  Dataset dataset = empty_set();
  for (const NamedMesh& model : models) {
    progress.begin(model.name);
    const SetPart part(folder, "views/" + model.name + ".csv");
    if (!part.is_finished()) make_model(part, model, options, dataset.attributes);
    part.add_to(dataset);
  }
  if (dataset.pairs.empty())
    throw InvalidInput("make_u3m", "pairs that overlap by 30 to 90 %", "none", "more views, or other models");
  folder.finish(dataset);
}

}  // namespace corral
