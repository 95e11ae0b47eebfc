// SPDX-License-Identifier: MIT
#include "apps/pair/match_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "apps/runtime/memory.h"
#include "apps/runtime/stopwatch.h"
#include "apps/runtime/workers.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/descriptor.h"
#include "kernel/surface/keypoints.h"

namespace corral {
namespace {

/// Resolutions that differ by more have no meaningful mean: metres and millimetres, most likely.
constexpr double kLargestRatio = 20;

/// More than any machine needs; a typing error must not bring it down.
constexpr int kMostThreads = 256;

/// A positive length, if the rule is one.
std::optional<double> as_length(const std::string& rule) {
  const auto value = parse_double(rule);
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

Keypoints detect(const Mesh& mesh, double resolution, const MatchSettings& settings, const ParallelFor& parallel) {
  if (settings.detector == "uniform") return detect_uniform(mesh.vertices, resolution, settings.keypoint_radius_pr);
  if (settings.detector == "harris-mesh") {
    HarrisMeshOptions options = settings.harris_mesh;
    options.radius_pr = settings.keypoint_radius_pr;
    return detect_harris_mesh(mesh, resolution, options);
  }
  return detect_harris(mesh.vertices, resolution, {settings.keypoint_radius_pr}, parallel);
}

/// One pair on its way from meshes to matches.
class Pipeline {
 public:
  Pipeline(const MatchSettings& settings, const StageObserver& observer, MatchReport& report)
      : settings_(settings), observer_(observer), report_(report) {}

  /// Returns the normals.
  Points measure(const Mesh& mesh, const std::string& side, SurfaceReport& report) {
    mesh.validate(side);
    report.points = static_cast<int>(mesh.vertices.rows());
    report.faces = static_cast<int>(mesh.triangles.rows());
    if (settings_.inspect) stage("topology of the " + side, [&] { report.topology = inspect_topology(mesh); });
    NormalsAndResolution found;
    stage("normals and resolution of the " + side, [&] {
      found = estimate_normals_and_resolution(mesh, normal_options(settings_), workers(settings_.threads));
    });
    report.resolution = found.resolution;
    return std::move(found.normals);
  }

  Descriptors describe(const Mesh& mesh, Points normals, const std::string& side, SurfaceReport& report) {
    SurfaceFeatures features =
        describe_surface(mesh, normals, report_.resolution, settings_,
                         [&](const std::string& name, const auto& work) { stage(name + " of the " + side, work); });
    const Descriptors& descriptors = features.descriptors;
    report.candidates = features.candidates;
    report.keypoints = features.keypoints;
    report.dropped_small_support = descriptors.dropped_small_support;
    report.dropped_no_frame = descriptors.dropped_no_frame;
    report.dropped_no_histogram = descriptors.dropped_no_histogram;
    report.descriptors = static_cast<int>(descriptors.vertices.size());
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

/// Advice on a radius (in the side's own pr) that is far from the usual one.
std::string radius_hint(const std::string& what, double radius_pr, double usual_pr) {
  if (radius_pr > usual_pr / 2 && radius_pr < usual_pr * 2) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", radius_pr);
  return "the " + what + " radius is " + text + " pr of this side, use about " + to_text(usual_pr) + " pr; ";
}

void add_hints(const MatchReport& report, const MatchSettings& settings, std::vector<std::string>& hints) {
  const auto hint = [&](const SurfaceReport& side, const std::string& name) {
    if (side.descriptors > 0) return;
    const double scale = report.resolution / side.resolution;  // from pr of the pair to the side's own
    if (side.keypoints == 0)
      hints.push_back("no keypoint on the " + name + ": " +
                      radius_hint("keypoint", settings.keypoint_radius_pr * scale, 3) + "a flat surface has none");
    else
      hints.push_back("no keypoint of the " + name +
                      " could be described: " + radius_hint("support", settings.support_radius_pr * scale, 15) +
                      "each needs 10 vertices around it");
  };
  hint(report.source, "source");
  hint(report.target, "target");
  if (report.matches == 0 && report.source.descriptors > 0 && report.target.descriptors > 0)
    hints.push_back("no match is mutual: the surfaces may share too little, or leave out --mutual");
}

void expect_one_of(const std::string& field, const std::string& value, const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : "|") + name;
  if (std::find(names.begin(), names.end(), value) == names.end())
    throw InvalidInput("match", field, "'" + value + "'", list);
}

}  // namespace

void MatchSettings::validate() const {
  if (resolution != "mean" && resolution != "source" && resolution != "target" && !as_length(resolution))
    throw InvalidInput("match", "--resolution", "'" + resolution + "'",
                       "mean|source|target or a length above zero in mesh units");
  expect_one_of("--detector", detector, {"harris", "harris-mesh", "uniform"});
  expect_one_of("--normals", normals, {"mesh", "origin"});
  expect_one_of("--shot", shot, {"additive", "pcl", "product"});
  require_positive("match", "--keypoint-radius-pr", keypoint_radius_pr);
  require_positive("match", "--support-radius-pr", support_radius_pr);
  if (sensor.size() != 3 || !std::all_of(sensor.begin(), sensor.end(), [](double x) { return std::isfinite(x); }))
    throw InvalidInput("match", "--sensor", "not a place", "three finite coordinates x,y,z");
  if (threads < 0 || threads > kMostThreads)
    throw InvalidInput("match", "--threads", std::to_string(threads), "0 .. " + std::to_string(kMostThreads));
  harris_mesh.validate();
  matching.validate();
}

double pair_resolution(const std::string& rule, double source, double target) {
  if (rule == "source") return source;
  if (rule == "target") return target;
  if (rule == "mean") {
    const double ratio = std::max(source, target) / std::min(source, target);
    if (!(ratio <= kLargestRatio))
      throw InvalidInput("match", "--resolution",
                         to_text(source) + " on the source and " + to_text(target) + " on the target",
                         "both in the same unit, or --resolution with the one to use");
    return (source + target) / 2;
  }
  return as_length(rule).value();
}

NormalOptions normal_options(const MatchSettings& settings) {
  return {20, settings.normals == "mesh", Eigen::Vector3d(settings.sensor.data())};
}

SurfaceFeatures describe_surface(const Mesh& mesh, const Points& normals, double resolution,
                                 const MatchSettings& settings, const StageRunner& stage) {
  const ParallelFor parallel = workers(settings.threads);
  Keypoints keypoints;
  SurfaceFeatures features;
  stage("keypoints", [&] { keypoints = detect(mesh, resolution, settings, parallel); });
  stage("descriptors", [&] {
    features.descriptors = describe_shot(mesh.vertices, normals, keypoints.vertices, resolution,
                                         {settings.support_radius_pr, 10, settings.shot}, parallel);
  });
  features.candidates = keypoints.candidates;
  features.keypoints = static_cast<int>(keypoints.vertices.size());
  return features;
}

CorrespondenceSet match_surfaces(const DescribedSurface& source, const DescribedSurface& target, double resolution,
                                 const MatchSettings& settings) {
  return make_correspondences(source, target, resolution, settings.matching, workers(settings.threads));
}

int match_stages(const MatchSettings& settings) { return settings.inspect ? 9 : 7; }

MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings,
                       const StageObserver& observer) {
  settings.validate();
  MatchedPair pair;
  MatchReport& report = pair.report;
  Pipeline pipeline(settings, observer, report);
  Points source_normals = pipeline.measure(source, "source", report.source);
  Points target_normals = pipeline.measure(target, "target", report.target);
  report.resolution = pair_resolution(settings.resolution, report.source.resolution, report.target.resolution);
  report.keypoint_radius = settings.keypoint_radius_pr * report.resolution;
  report.support_radius = settings.support_radius_pr * report.resolution;
  const Descriptors on_source = pipeline.describe(source, std::move(source_normals), "source", report.source);
  const Descriptors on_target = pipeline.describe(target, std::move(target_normals), "target", report.target);
  pair.matches = pipeline.match({source, on_source}, {target, on_target});
  report.matches = pair.matches.size();
  add_hints(report, settings, report.hints);
  return pair;
}

}  // namespace corral
