// SPDX-License-Identifier: MIT
#include "apps/pair/match_pair.h"

#include <cstdio>
#include <utility>

#include "apps/pair/surface_warnings.h"
#include "apps/runtime/memory.h"
#include "apps/runtime/stopwatch.h"
#include "apps/runtime/workers.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/resolution.h"
#include "kernel/surface/shot.h"

namespace corral {
namespace {

using StageRunner = std::function<void(const std::string& stage, const std::function<void()>& work)>;
void run_stage(const std::string&, const std::function<void()>& work) { work(); }

/// Keypoints -> descriptors and frames.
SurfaceFeatures describe(const Mesh& mesh, const Points& normals, double resolution, const MatchSettings& settings,
                         const StageRunner& stage = run_stage) {
  const ParallelFor parallel = workers(settings.threads);
  Keypoints keypoints;
  SurfaceFeatures features;
  stage("keypoints", [&] { keypoints = settings.configured_detector().detect({mesh, resolution, parallel}); });
  stage("descriptors", [&] {
    features.descriptors =
        settings.configured_descriptor().describe({mesh.vertices, normals, keypoints.vertices, resolution, parallel});
    if (settings.frames == LocalFrames::None)
      features.descriptors.frames.clear();
    else if (!find_descriptor(settings.descriptor).has_frames)
      add_shot_frames(mesh.vertices, resolution, parse_options<ShotOptions>(settings.options_of("shot"), "shot"),
                      features.descriptors, parallel);
  });
  features.candidates = keypoints.candidates;
  features.keypoints = static_cast<int>(keypoints.vertices.size());
  return features;
}

/// The stages of one pair from meshes to matches.
class Pipeline {
 public:
  Pipeline(const MatchSettings& settings, const StageObserver& observer, MatchReport& report)
      : settings_(settings), observer_(observer), report_(report) {}

  /// A surface with what was measured on it. Normals wait until they are needed where the features may be in a cache.
  struct Side {
    const Mesh& mesh;
    std::string name;
    SurfaceReport& report;
    const FeatureCache& cache;
    Points normals{};
  };

  void measure(Side& side) {
    side.mesh.validate(side.name);
    side.report.points = static_cast<int>(side.mesh.vertices.rows());
    side.report.faces = static_cast<int>(side.mesh.triangles.rows());
    if (settings_.inspect)
      stage("topology of the " + side.name, [&] { side.report.topology = inspect_topology(side.mesh); });
    side.report.normals = normal_guide(side.mesh, settings_.normal_options());
    stage("normals and resolution of the " + side.name, [&] {
      if (side.cache) {
        side.report.spacing = point_spacing(side.mesh.vertices);
        return;
      }
      NormalsAndResolution found =
          estimate_normals_and_resolution(side.mesh, settings_.normal_options(), workers(settings_.threads));
      side.report.spacing = std::move(found.spacing);
      side.normals = std::move(found.normals);
    });
    side.report.resolution = side.report.spacing.resolution;
    for (const std::string& warning : surface_warnings(side.mesh, side.report.spacing))
      report_.warnings.push_back(side.name + ": " + warning);
  }

  Descriptors describe(Side& side) {
    SurfaceFeatures features;
    if (side.cache)
      features =
          side.cache(report_.resolution, [&] { return describe_surface(side.mesh, report_.resolution, settings_); });
    else
      features = corral::describe(
          side.mesh, side.normals, report_.resolution, settings_,
          [&](const std::string& name, const auto& work) { stage(name + " of the " + side.name, work); });
    side.normals = Points();
    const Descriptors& descriptors = features.descriptors;
    side.report.candidates = features.candidates;
    side.report.keypoints = features.keypoints;
    side.report.dropped_small_support = descriptors.dropped_small_support;
    side.report.dropped_no_frame = descriptors.dropped_no_frame;
    side.report.dropped_no_histogram = descriptors.dropped_no_histogram;
    side.report.descriptors = static_cast<int>(descriptors.vertices.size());
    return std::move(features.descriptors);
  }

  CorrespondenceSet match(const DescribedSurface& source, const DescribedSurface& target) {
    CorrespondenceSet matches;
    stage("matching", [&] { matches = match_surfaces(source, target, report_.resolution, settings_); });
    return matches;
  }

 private:
  void stage(const std::string& name, const std::function<void()>& work) {
    if (observer_) observer_(name);
    Stopwatch watch;
    work();
    report_.stages.push_back({name, watch.lap_ms(), peak_memory_mb()});
  }

  const MatchSettings& settings_;
  const StageObserver& observer_;
  MatchReport& report_;
};

std::vector<UsedLength> lengths_of(const MatchSettings& settings) {
  std::vector<UsedLength> lengths;
  for (const std::string& name : settings.in_use()) {
    const std::vector<OptionValue> usual = surface_options({}, name);
    std::size_t i = 0;
    for (const OptionValue& option : surface_options(settings, name)) {
      const OptionValue& default_value = usual[i++];
      if (option.unit == "pr")
        lengths.push_back(
            {name + "." + option.name, parse_double(option.value).value(), parse_double(default_value.value).value()});
    }
  }
  return lengths;
}

/// Advice on the lengths of one algorithm that, in the side's own pr, are far from the usual ones.
std::string length_hint(const MatchReport& report, const std::string& algorithm, double scale) {
  std::string text;
  for (const UsedLength& length : report.lengths) {
    const double pr = length.pr * scale;
    if (length.name.rfind(algorithm + ".", 0) != 0 || (pr > length.usual_pr / 2 && pr < length.usual_pr * 2)) continue;
    char number[32];
    std::snprintf(number, sizeof number, "%.3g", pr);
    text += length.name + " is " + number + " pr of this side, use about " + to_text(length.usual_pr) + " pr; ";
  }
  return text;
}

double resolution_of_pair(const MatchReport& report, const MatchSettings& settings) {
  std::string strays;
  for (const auto& [name, side] : {std::pair{"source", &report.source}, {"target", &report.target}}) {
    const std::string warning = stray_warning(side->spacing);
    if (!warning.empty()) strays += std::string("; ") + name + ": " + warning;
  }
  return pair_resolution(settings.resolution, report.source.resolution, report.target.resolution, strays);
}

void warn_of_units(const Mesh& source, const Mesh& target, MatchReport& report) {
  if (!report.source.spacing.strays.empty() || !report.target.spacing.strays.empty()) return;  // extents say nothing
  report.units = unit_warning(size_of(source.vertices, report.source.resolution),
                              size_of(target.vertices, report.target.resolution));
}

void add_hints(const MatchReport& report, const MatchSettings& settings, std::vector<std::string>& hints) {
  const std::string sides = normal_hint(report.source.normals, report.target.normals);
  if (!sides.empty()) hints.push_back(sides);
  const auto hint = [&](const SurfaceReport& side, const std::string& name) {
    if (side.descriptors > 0) return;
    const double scale = report.resolution / side.resolution;  // from pr of the pair to the side's own
    if (side.keypoints == 0)
      hints.push_back("no keypoint on the " + name + ": " + length_hint(report, settings.detector, scale) +
                      "a flat surface has none");
    else
      hints.push_back("no keypoint of the " + name + " could be described: " +
                      length_hint(report, settings.descriptor, scale) + "each needs enough vertices around it");
  };
  hint(report.source, "source");
  hint(report.target, "target");
  if (report.matches == 0 && report.source.descriptors > 0 && report.target.descriptors > 0)
    hints.push_back("no match is mutual: the surfaces may overlap too little; try without --mutual");
}

}  // namespace

SurfaceFeatures describe_surface(const Mesh& mesh, double resolution, const MatchSettings& settings) {
  return describe(mesh, estimate_normals(mesh, settings.normal_options(), workers(settings.threads)), resolution,
                  settings);
}

CorrespondenceSet match_surfaces(const DescribedSurface& source, const DescribedSurface& target, double resolution,
                                 const MatchSettings& settings) {
  return make_correspondences(source, target, resolution, settings.matching, workers(settings.threads));
}

int match_stages(const MatchSettings& settings) { return settings.inspect ? 9 : 7; }

MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings, const MatchHooks& hooks) {
  settings.validate();
  MatchedPair pair;
  MatchReport& report = pair.report;
  Pipeline pipeline(settings, hooks.observer, report);
  Pipeline::Side on_source{source, "source", report.source, hooks.source};
  Pipeline::Side on_target{target, "target", report.target, hooks.target};
  pipeline.measure(on_source);
  pipeline.measure(on_target);
  report.resolution = resolution_of_pair(report, settings);
  warn_of_units(source, target, report);
  report.lengths = lengths_of(settings);
  const Descriptors source_features = pipeline.describe(on_source);
  const Descriptors target_features = pipeline.describe(on_target);
  pair.matches = pipeline.match({source, source_features}, {target, target_features});
  report.matches = pair.matches.size();
  add_hints(report, settings, report.hints);
  return pair;
}

}  // namespace corral
