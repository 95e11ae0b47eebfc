// SPDX-License-Identifier: MIT
#include "apps/runtime/report.h"

#include <algorithm>
#include <cstdio>

#include "io/file.h"
#include "kernel/error.h"
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
          {"non_manifold_faces", topology.non_manifold_faces}};
}

Json to_json(const SurfaceReport& report) {
  return {{"points", report.points},
          {"faces", report.faces},
          {"topology", report.topology ? to_json(*report.topology) : Json(nullptr)},
          {"resolution", report.resolution},
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
                                    {topology.non_manifold_faces, "non-manifold faces"}})
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  return text;
}

std::string surface_lines(const char* name, const SurfaceReport& side) {
  std::string text = std::string(name) + ": " + std::to_string(side.points) + " points, " + std::to_string(side.faces) +
                     " faces" + (side.faces == 0 ? " (a cloud: normals towards the sensor)" : "");
  if (side.topology && side.faces > 0) text += ", " + std::to_string(side.topology->components) + " components";
  if (side.topology) text += oddities(*side.topology);
  return text + ", pr " + to_text(side.resolution) + "\n  " + std::to_string(side.keypoints) + " keypoints of " +
         std::to_string(side.candidates) + " candidates, dropped " + std::to_string(side.dropped_small_support) +
         " with fewer than 10 neighbours, " + std::to_string(side.dropped_no_frame) + " without a frame, " +
         std::to_string(side.dropped_no_histogram) + " without a histogram; " + std::to_string(side.descriptors) +
         " described\n";
}

}  // namespace

Json to_json(const RigidTransform& transform) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back({transform.rotation(row, 0), transform.rotation(row, 1), transform.rotation(row, 2),
                    transform.translation(row)});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

Json to_json(const MatchReport& report) {
  Json stages = Json::array();
  for (const StageCost& cost : report.stages)
    stages.push_back({{"stage", cost.stage}, {"time_ms", cost.time_ms}, {"peak_memory_mb", cost.peak_memory_mb}});
  return {{"resolution", report.resolution},
          {"keypoint_radius", report.keypoint_radius},
          {"support_radius", report.support_radius},
          {"source", to_json(report.source)},
          {"target", to_json(report.target)},
          {"matches", report.matches},
          {"stages", stages},
          {"hints", report.hints}};
}

Json to_json(const MatchSettings& settings) {
  Json json = {{"resolution_rule", settings.resolution},
               {"detector", settings.detector},
               {"keypoint_radius_pr", settings.keypoint_radius_pr},
               {"support_radius_pr", settings.support_radius_pr},
               {"normals", settings.normals},
               {"sensor", settings.sensor},
               {"shot", settings.shot},
               {"matcher", settings.matching.matcher},
               {"mutual", settings.matching.mutual}};
  if (settings.detector == "harris-mesh")
    json["harris_mesh"] = {{"neighborhood", settings.harris_mesh.neighborhood},
                           {"rings", settings.harris_mesh.rings},
                           {"extent", settings.harris_mesh.extent},
                           {"selection", settings.harris_mesh.selection},
                           {"fraction", settings.harris_mesh.fraction},
                           {"separation", settings.harris_mesh.separation}};
  return json;
}

Json to_json(const GroupingScore& score) {
  return {{"matches", score.matches},
          {"selected", score.selected},
          {"correct", score.correct},
          {"true_matches", score.true_matches},
          {"precision", json_or_null(score.precision)},
          {"recall", json_or_null(score.recall)},
          {"f1", json_or_null(score.f1)}};
}

Json typed(const std::string& value) {
  if (value == "true" || value == "false") return value == "true";
  if (const auto whole = parse_unsigned(value)) return *whole;
  if (const auto number = parse_double(value)) return *number;
  return value;
}

Json to_json(const std::vector<OptionValue>& options) {
  Json json = Json::object();
  for (const OptionValue& option : options) json[option.name] = typed(option.value);
  return json;
}

std::string stage_report(const MatchReport& report) {
  std::string text = surface_lines("source", report.source) + surface_lines("target", report.target) + "pair: pr " +
                     to_text(report.resolution) + ", keypoint radius " + to_text(report.keypoint_radius) +
                     ", support radius " + to_text(report.support_radius) + " mesh units; " +
                     std::to_string(report.matches) + " matches\n";
  TextTable table({"stage", "time ms", "peak memory MB"});
  for (const StageCost& cost : report.stages)
    table.add({cost.stage, fixed(cost.time_ms, 1), fixed(cost.peak_memory_mb, 1)});
  text += table.str();
  for (const std::string& hint : report.hints) text += "hint: " + hint + "\n";
  text.pop_back();
  return text;
}

TextTable::TextTable(std::vector<std::string> header) { rows_.push_back(std::move(header)); }

void TextTable::add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

std::string TextTable::str() const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 1);
  std::vector<bool> is_text(columns, false);
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::string& cell = rows_[row].at(i);
      widths[i] = std::max(widths[i], cell.size());
      if (row > 0 && !cell.empty() && !parse_double(cell)) is_text[i] = true;
    }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string cell = row[i].empty() ? "-" : row[i];
      const std::string space(widths[i] - cell.size(), ' ');
      line += (i > 0 ? "  " : "") + (is_text[i] ? cell + space : space + cell);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string TextTable::markdown() const {
  std::string text;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    text += "|";
    for (const std::string& cell : rows_[row]) {
      std::string escaped;
      for (const char letter : cell) escaped += letter == '|' ? std::string("\\|") : std::string(1, letter);
      text += " " + escaped + " |";
    }
    text += "\n";
    if (row > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < rows_[0].size(); ++i) text += " --- |";
    text += "\n";
  }
  return text;
}

std::string table_text(const std::vector<Json>& rows, const std::vector<TableColumn>& columns) {
  std::vector<std::string> header;
  for (const TableColumn& column : columns) header.push_back(column.header);
  TextTable table(header);
  for (const Json& row : rows) {
    std::vector<std::string> cells;
    for (const TableColumn& column : columns) {
      const Json& value = row.at(column.key);
      if (value.is_number())
        cells.push_back(fixed(value.get<double>(), column.decimals));
      else
        cells.push_back(value.is_null() ? "" : value.get<std::string>());
    }
    table.add(cells);
  }
  return table.str();
}

std::string fixed(std::optional<double> value, int decimals) {
  if (!value) return "";
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, "%.*f", decimals, *value)) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", decimals, *value);
  text.pop_back();
  return text;
}

void put(const std::string& path, const std::string& text) {
  if (!path.empty()) return write_file(path, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw IoError("standard output", "", "cannot be written");
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

void put(const std::string& path, const Json& json) { put(path, json_text(json)); }

void say(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

}  // namespace corral
