// SPDX-License-Identifier: MIT
#include "apps/report.h"

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

/// The members that a pose against the truth has; null where it has none.
void add_errors(Json& json, const std::optional<PoseErrors>& errors) {
  std::optional<double> rotation, translation, rmse, mean;
  if (errors) {
    rotation = errors->rotation_error_deg;
    translation = errors->translation_error_pr;
    if (errors->points) rmse = errors->points->rmse_pr, mean = errors->points->mean_pr;
  }
  json["rotation_error_deg"] = json_or_null(rotation);
  json["translation_error_pr"] = json_or_null(translation);
  json["rmse_pr"] = json_or_null(rmse);
  json["mean_error_pr"] = json_or_null(mean);
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

/// What a row of the table of methods holds, in its order, with so many decimals for people (-1: a whole number).
struct Cell {
  std::optional<double> value;
  int decimals;
};
std::vector<Cell> cells(const MethodRecord& record) {
  std::optional<double> selected, precision, recall, f1, time, rotation, translation, rmse;
  if (record.failure.empty()) selected = static_cast<double>(record.found.selected.size()), time = record.time_ms;
  if (record.score && record.failure.empty())
    precision = record.score->precision, recall = record.score->recall, f1 = record.score->f1;
  if (record.errors) {
    rotation = record.errors->rotation_error_deg;
    translation = record.errors->translation_error_pr;
    if (record.errors->points) rmse = record.errors->points->rmse_pr;
  }
  return {{selected, 0}, {precision, 3}, {recall, 3}, {f1, 3}, {time, 2}, {rotation, 3}, {translation, 3}, {rmse, 3}};
}

const std::vector<std::string> kColumns = {"method",  "selected", "precision",          "recall",
                                           "f1",      "time_ms",  "rotation_error_deg", "translation_error_pr",
                                           "rmse_pr", "status"};

/// The same for the dense refinement.
std::vector<Cell> dense_cells(const MethodRecord& record) {
  std::optional<double> overlap_before, overlap, rms_before, rms, rotation, translation, rmse;
  if (record.dense) {
    overlap_before = record.dense->before.overlap, rms_before = record.dense->before.rms_pr;
    overlap = record.dense->after.overlap, rms = record.dense->after.rms_pr;
  }
  if (record.dense_errors) {
    rotation = record.dense_errors->rotation_error_deg;
    translation = record.dense_errors->translation_error_pr;
    if (record.dense_errors->points) rmse = record.dense_errors->points->rmse_pr;
  }
  return {{overlap_before, 3}, {overlap, 3}, {rms_before, 3}, {rms, 3}, {rotation, 4}, {translation, 4}, {rmse, 4}};
}

std::string dense_status(const MethodRecord& record) {
  return record.dense ? to_text(record.dense->status) : "no pose to begin with";
}

const std::vector<std::string> kDenseColumns = {"method",
                                                "overlap_before",
                                                "overlap",
                                                "residual_before_pr",
                                                "residual_pr",
                                                "rotation_error_deg",
                                                "translation_error_pr",
                                                "rmse_pr",
                                                "status"};

/// Texts between commas, on a line; what a text holds that would end its field is replaced.
std::string csv_line(const std::string& first, const std::vector<Cell>& numbers, std::string last) {
  std::string line = first;
  for (const Cell& cell : numbers) line += "," + (cell.value ? to_text(*cell.value) : "");
  std::replace_if(
      last.begin(), last.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ';');
  return line + "," + last + "\n";
}

std::string csv_header(const std::vector<std::string>& columns) {
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
  return text + "\n";
}

std::vector<std::string> text_row(const std::string& first, const std::vector<Cell>& numbers, const std::string& last) {
  std::vector<std::string> row{first};
  for (const Cell& cell : numbers) row.push_back(fixed(cell.value, cell.decimals));
  row.push_back(last);
  return row;
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

Json to_json(const RefinedPose& pose, const std::optional<PoseErrors>& errors) {
  Json json = {{"status", to_text(pose.status)},
               {"target_from_source", pose.target_from_source ? to_json(*pose.target_from_source) : Json(nullptr)}};
  add_errors(json, errors);
  json["iterations"] = pose.iterations;
  json["converged"] = pose.converged;
  json["initial"] = pose.initial ? to_json(*pose.initial) : Json(nullptr);
  json["initial_rms_pr"] = pose.initial ? Json(pose.initial_rms_pr) : Json(nullptr);
  json["final_rms_pr"] = pose.target_from_source ? Json(pose.final_rms_pr) : Json(nullptr);
  json["initial_cost"] = pose.initial ? Json(pose.initial_cost) : Json(nullptr);
  json["final_cost"] = pose.target_from_source ? Json(pose.final_cost) : Json(nullptr);
  json["condition"] = json_or_null(pose.condition);
  json["covariance"] = nullptr;
  if (pose.covariance) {
    json["covariance"] = Json::array();
    for (int row = 0; row < 6; ++row) {
      Json numbers = Json::array();
      for (int column = 0; column < 6; ++column) numbers.push_back((*pose.covariance)(row, column));
      json["covariance"].push_back(numbers);
    }
  }
  return json;
}

Json to_json(const MethodRecord& record) {
  Json json = {{"method", record.method}};
  const std::vector<Cell> values = cells(record);
  for (std::size_t i = 0; i < values.size(); ++i) json[kColumns[i + 1]] = json_or_null(values[i].value);
  if (values[0].value) json["selected"] = record.found.selected.size();
  json["status"] = record.status();
  if (!record.dense) return json;
  const std::vector<Cell> dense = dense_cells(record);
  for (std::size_t i = 0; i < dense.size(); ++i) json["dense"][kDenseColumns[i + 1]] = json_or_null(dense[i].value);
  json["dense"]["condition"] = record.dense->condition;
  json["dense"]["pose"] = record.dense->target_from_source ? to_json(*record.dense->target_from_source) : Json(nullptr);
  json["dense"]["status"] = dense_status(record);
  return json;
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

std::string fixed(std::optional<double> value, int decimals) {
  if (!value) return "";
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, "%.*f", decimals, *value)) + 1, '\0');
  std::snprintf(text.data(), text.size(), "%.*f", decimals, *value);
  text.pop_back();
  return text;
}

std::string methods_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds) {
  TextTable table({"method", "selected", "precision", "recall", "F1", "time ms", "rot err deg", "transl err pr",
                   "RMSE pr", "status"});
  for (const auto* part : {&records, &bounds})
    for (const MethodRecord& record : *part) table.add(text_row(record.method, cells(record), record.status()));
  return table.str();
}

std::string methods_csv(const std::vector<MethodRecord>& records) {
  std::string text = csv_header(kColumns);
  for (const MethodRecord& record : records) text += csv_line(record.method, cells(record), record.status());
  return text;
}

std::string dense_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds) {
  TextTable table({"method", "overlap before", "overlap", "residual before pr", "residual pr", "rot err deg",
                   "transl err pr", "RMSE pr", "status"});
  for (const auto* part : {&records, &bounds})
    for (const MethodRecord& record : *part)
      table.add(text_row(record.method, dense_cells(record), dense_status(record)));
  return table.str();
}

std::string dense_csv(const std::vector<MethodRecord>& records) {
  std::string text = csv_header(kDenseColumns);
  for (const MethodRecord& record : records) text += csv_line(record.method, dense_cells(record), dense_status(record));
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
