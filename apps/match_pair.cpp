// SPDX-License-Identifier: MIT
#include "apps/match_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/stopwatch.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/descriptor.h"
#include "kernel/surface/feature_matching.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/resolution.h"

namespace corral {
namespace {

/// Resolutions that differ by more have no meaningful mean: metres and millimetres, most likely.
constexpr double kLargestRatio = 20;

/// A positive length, if the rule is one.
std::optional<double> as_length(const std::string& rule) {
  const auto value = parse_double(rule);
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

double pair_resolution(const std::string& rule, double source, double target) {
  if (rule == "source") return source;
  if (rule == "target") return target;
  if (rule == "mean") {
    const double ratio = std::max(source, target) / std::min(source, target);
    if (!(ratio <= kLargestRatio))
      throw InvalidInput("match", "resolution",
                         to_text(source) + " on the source and " + to_text(target) + " on the target",
                         "both in the same unit, or --resolution with the one to use");
    return (source + target) / 2;
  }
  return as_length(rule).value();
}

Descriptors describe(const Mesh& mesh, const std::string& side, double resolution, const MatchSettings& settings,
                     SurfaceReport& report, const StageObserver& observe) {
  const PointIndex index(mesh.vertices);
  observe("keypoints of the " + side);
  Stopwatch watch;
  const Keypoints keypoints =
      detect_harris(mesh, index, resolution, {settings.keypoint_radius_pr, settings.support_radius_pr});
  report.keypoints_ms = watch.lap_ms();
  observe("normals of the " + side);
  const Points normals = estimate_normals(mesh, index);
  report.normals_ms = watch.lap_ms();
  observe("descriptors of the " + side);
  Descriptors descriptors =
      describe_shot(mesh, normals, index, keypoints.vertices, resolution, settings.support_radius_pr);
  report.descriptors_ms = watch.lap_ms();
  report.candidates = keypoints.candidates;
  report.dropped_small_support = keypoints.dropped_small_support;
  report.dropped_no_frame = descriptors.dropped_no_frame;
  report.dropped_no_histogram = descriptors.dropped_no_histogram;
  report.keypoints = static_cast<int>(descriptors.vertices.size());
  return descriptors;
}

/// Advice on a radius (in the side's own pr) that is far from the usual one.
std::string radius_hint(const std::string& what, double radius_pr, double usual_pr) {
  if (radius_pr > usual_pr / 2 && radius_pr < usual_pr * 2) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", radius_pr);
  return "the " + what + " radius is " + text + " pr of this side, use about " + to_text(usual_pr) + " pr; ";
}

void add_hints(const MatchReport& report, const MatchSettings& settings, std::vector<std::string>& hints) {
  const auto hint = [&](const SurfaceReport& side, const std::string& name) {
    if (side.keypoints > 0) return;
    const double scale = report.resolution / side.resolution;  // from pr of the pair to the side's own
    if (side.candidates == 0)
      hints.push_back("no keypoint on the " + name + ": " +
                      radius_hint("keypoint", settings.keypoint_radius_pr * scale, 3) + "a flat surface has none");
    else
      hints.push_back("no keypoint of the " + name +
                      " could be described: " + radius_hint("support", settings.support_radius_pr * scale, 15) +
                      "each needs 10 vertices around it");
  };
  hint(report.source, "source");
  hint(report.target, "target");
}

}  // namespace

void check_resolution_rule(const std::string& rule) {
  if (rule != "mean" && rule != "source" && rule != "target" && !as_length(rule))
    throw InvalidInput("match", "resolution", "'" + rule + "'",
                       "mean|source|target or a length above zero in mesh units");
}

MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings,
                       const StageObserver& observer) {
  check_resolution_rule(settings.resolution);
  const StageObserver observe = observer ? observer : [](const std::string&) {};
  MatchedPair pair;
  MatchReport& report = pair.report;
  Stopwatch watch;
  for (auto [mesh, side, name] : {std::tuple{&source, &report.source, "source"}, {&target, &report.target, "target"}}) {
    observe(std::string("resolution of the ") + name);
    mesh->validate(name);
    side->points = static_cast<int>(mesh->vertices.rows());
    side->faces = static_cast<int>(mesh->triangles.rows());
    side->resolution = point_resolution(mesh->vertices);
    side->resolution_ms = watch.lap_ms();
  }
  report.resolution = pair_resolution(settings.resolution, report.source.resolution, report.target.resolution);
  report.keypoint_radius = settings.keypoint_radius_pr * report.resolution;
  report.support_radius = settings.support_radius_pr * report.resolution;
  const Descriptors on_source = describe(source, "source", report.resolution, settings, report.source, observe);
  const Descriptors on_target = describe(target, "target", report.resolution, settings, report.target, observe);
  observe("matching");
  watch.lap_ms();
  pair.matches = make_correspondences(source, on_source, target, on_target, report.resolution);
  report.matching_ms = watch.lap_ms();
  report.matches = pair.matches.size();
  add_hints(report, settings, report.hints);
  return pair;
}

}  // namespace corral
