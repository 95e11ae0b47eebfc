// SPDX-License-Identifier: MIT
#include "apps/pair/match_report.h"

#include "apps/pair/surface_warnings.h"
#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

Json to_json(const Topology& topology) {
  return {{"components", topology.components},
          {"boundary_edges", topology.boundary_edges},
          {"duplicates", topology.duplicate_vertices},
          {"isolated", topology.isolated_vertices},
          {"degenerate_faces", topology.degenerate_faces},
          {"misoriented_faces", topology.misoriented_faces},
          {"non_manifold_edges", topology.non_manifold_edges},
          {"non_manifold_vertices", topology.non_manifold_vertices}};
}

Json to_json(const SurfaceReport& report) {
  return {{"points", report.points},
          {"faces", report.faces},
          {"topology", report.topology ? to_json(*report.topology) : Json(nullptr)},
          {"resolution", report.resolution},
          {"median_spacing", report.spacing.median},
          {"strays", report.spacing.strays.size()},
          {"normals", to_text(report.normals)},
          {"candidates", report.candidates},
          {"keypoints", report.keypoints},
          {"dropped_small_support", report.dropped_small_support},
          {"dropped_no_frame", report.dropped_no_frame},
          {"dropped_no_histogram", report.dropped_no_histogram},
          {"descriptors", report.descriptors}};
}

/// The counts that are not zero, or nothing.
std::string oddities(const Topology& topology) {
  std::string text;
  for (const auto& [count, what] : {std::pair{topology.duplicate_vertices, "duplicate vertices"},
                                    {topology.isolated_vertices, "isolated vertices"},
                                    {topology.degenerate_faces, "faces without area"},
                                    {topology.misoriented_faces, "misoriented faces"},
                                    {topology.non_manifold_edges, "non-manifold edges"},
                                    {topology.non_manifold_vertices, "non-manifold vertices"}})
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  return text;
}

std::string surface_lines(const char* name, const SurfaceReport& side) {
  std::string text = std::string(name) + ": " + std::to_string(side.points) + " points, " + std::to_string(side.faces) +
                     " faces, normals " + to_text(side.normals);
  if (side.topology && side.faces > 0) text += ", " + std::to_string(side.topology->components) + " components";
  if (side.topology) text += oddities(*side.topology);
  return text + ", pr " + to_text(side.resolution) + "\n  " + std::to_string(side.keypoints) + " keypoints of " +
         std::to_string(side.candidates) + " candidates, dropped " + std::to_string(side.dropped_small_support) +
         " with too few vertices around, " + std::to_string(side.dropped_no_frame) + " without a frame, " +
         std::to_string(side.dropped_no_histogram) + " without a histogram; " + std::to_string(side.descriptors) +
         " described\n";
}

}  // namespace

Json to_json(const MatchReport& report) {
  Json stages = Json::array();
  for (const StageCost& cost : report.stages)
    stages.push_back({{"stage", cost.stage}, {"time_ms", cost.time_ms}, {"peak_memory_mb", cost.peak_memory_mb}});
  Json lengths = Json::object();
  for (const UsedLength& length : report.lengths) lengths[length.name] = length.pr * report.resolution;
  return {{"resolution", report.resolution},  {"lengths", lengths},        {"source", to_json(report.source)},
          {"target", to_json(report.target)}, {"matches", report.matches}, {"stages", stages},
          {"warnings", warnings_of(report)},  {"hints", report.hints}};
}

std::vector<std::string> warnings_of(const MatchReport& report) {
  std::vector<std::string> warnings = report.warnings;
  if (!report.units.empty()) warnings.push_back(report.units);
  return warnings;
}

std::vector<std::string> advice(const MatchReport& report) {
  std::vector<std::string> lines;
  for (const std::string& warning : warnings_of(report)) lines.push_back("warning: " + warning);
  for (const std::string& hint : report.hints) lines.push_back("hint: " + hint);
  return lines;
}

std::string stage_report(const MatchReport& report) {
  std::string text = surface_lines("source", report.source) + surface_lines("target", report.target) + "pair: pr " +
                     to_text(report.resolution);
  for (const UsedLength& length : report.lengths)
    text += ", " + length.name + " " + to_text(length.pr) + " (" + to_text(length.pr * report.resolution) + ")";
  text += " mesh units; " + std::to_string(report.matches) + " matches\n";
  TextTable table({"stage", "time ms", "peak memory MB"});
  for (const StageCost& cost : report.stages)
    table.add({cost.stage, fixed(cost.time_ms, 1), fixed(cost.peak_memory_mb, 1)});
  text += table.str();
  for (const std::string& line : advice(report)) text += line + "\n";
  text.pop_back();
  return text;
}

}  // namespace corral
