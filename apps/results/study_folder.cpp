// SPDX-License-Identifier: MIT
#include "apps/results/study_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/disk/file.h"
#include "io/text/csv_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

using Json = nlohmann::json;

ExperimentInfo experiment_of(const Json& json) {
  ExperimentInfo info;
  info.name = json.at("name");
  info.title = json.at("title");
  info.figure = json.at("figure");
  info.dataset = json.at("dataset");
  info.attribute = json.at("attribute");
  info.axis = json.at("axis");
  for (const Json& level : json.at("levels"))
    info.levels.push_back({level.at("label"), level.at("low"), level.at("high")});
  info.methods = json.at("methods").get<std::vector<std::string>>();
  for (const Json& method : json.at("foreign_methods")) info.titles[method.at("name")] = method.at("title");
  info.threshold_pr = json.at("threshold_pr");
  info.least_true_matches = json.at("least_true_matches");
  return info;
}

StudyPair pair_of(const Json& json) {
  StudyPair pair{json.at("source"), json.at("target"), json.at("truth"), json.at("resolution"), {}, {}};
  if (json.contains("source_points")) pair.source_points = json.at("source_points").get<int>();
  if (json.contains("source_keypoints")) pair.source_keypoints = json.at("source_keypoints").get<int>();
  return pair;
}

/// How deep the values of a JSON text are nested.
int depth_of(const std::string& text) {
  int depth = 0, deepest = 0;
  bool is_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char letter = text[at];
    if (letter == '"') is_string = !is_string;
    if (is_string) {
      at += letter == '\\' ? 1 : 0;
    } else if (letter == '{' || letter == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (letter == '}' || letter == ']') {
      --depth;
    }
  }
  return deepest;
}

/// A deeply nested value would overflow the stack when it is written. (A callback of the parser could see it too, but the
/// parser then walks through all pairs behind each of them.)
Json parse_manifest(const std::string& path) {
  const std::string text = read_file(path);
  if (depth_of(text) > 100) throw IoError(path, "", "is not the manifest of a study: nested more than 100 deep");
  return Json::parse(text);
}

double number_cell(const std::string& path, std::size_t row, const std::string& cell) {
  const std::optional<double> number = parse_double(cell);
  if (!number || !std::isfinite(*number))
    throw IoError(path, "row " + std::to_string(row + 1),
                  "found " + corral::quoted(cell) + ", expected a finite number");
  return *number;
}

int index_cell(const std::string& path, std::size_t row, const std::string& cell) {
  const auto number = parse_int(cell);
  if (!number || *number < 0 || *number > 1'000'000'000)
    throw IoError(path, "row " + std::to_string(row + 1),
                  "found " + corral::quoted(cell) + ", expected a number of a vertex");
  return static_cast<int>(*number);
}

const std::vector<std::string> kPoseColumns = {"method", "stage", "r11", "r12", "r13", "t1",  "r21",
                                               "r22",    "r23",   "t2",  "r31", "r32", "r33", "t3"};

}  // namespace

StudyFolder read_study(const std::string& folder) {
  StudyFolder run;
  run.folder = folder;
  const std::string path = (std::filesystem::path(folder) / "manifest.json").string();
  const std::string records = (std::filesystem::path(folder) / "records.csv").string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    if (std::filesystem::exists(std::filesystem::path(folder) / "units", ignored))
      throw IoError(
          folder, "",
          "is an unfinished study; repeat the command that makes it to continue, or 'corral merge' its shards");
    throw IoError(path, "", "does not exist, expected a folder that 'corral evaluate' made");
  }
  try {
    const Json manifest = parse_manifest(path);
    for (const Json& experiment : manifest.at("experiments")) run.experiments.push_back(experiment_of(experiment));
    for (const auto& [name, pair] : manifest.at("pairs").items()) run.pairs[name] = pair_of(pair);
  } catch (const Json::parse_error& error) {
    throw IoError(path, "byte " + std::to_string(error.byte), "is not JSON, expected the manifest of a study");
  } catch (const Json::exception&) {
    throw IoError(path, "", "is not the manifest of a study, or of one made by another version of the program");
  }
  if (!std::filesystem::exists(records, ignored))
    throw IoError(folder, "", "is unfinished: it has no records.csv; repeat the command that makes it to continue");
  run.records = read_records(records);
  return run;
}

PairSelections read_selections(const std::string& path) {
  const CsvTable table = read_csv(path);
  const std::vector<std::string> first = {"source_keypoint", "target_keypoint", "residual_pr"};
  if (table.header.size() < 3 || !std::equal(first.begin(), first.end(), table.header.begin()))
    throw IoError(path, "header", "expected source_keypoint,target_keypoint,residual_pr and the groupers");
  PairSelections selections;
  for (std::size_t column = 3; column < table.header.size(); ++column) selections.selected[table.header[column]];
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto& cells = table.rows[row];
    if (!cells[0].empty() || !cells[1].empty()) {
      selections.source_keypoints.push_back(index_cell(path, row, cells[0]));
      selections.target_keypoints.push_back(index_cell(path, row, cells[1]));
    }
    if (!cells[2].empty()) selections.residual_pr.push_back(number_cell(path, row, cells[2]));
    for (std::size_t column = 3; column < cells.size(); ++column) {
      if (cells[column] != "0" && cells[column] != "1")
        throw IoError(path, "row " + std::to_string(row + 1),
                      "found " + corral::quoted(cells[column]) + ", expected 0 or 1");
      if (cells[column] == "1") selections.selected[table.header[column]].push_back(static_cast<int>(row));
    }
  }
  selections.matches = table.rows.size();
  if (!selections.residual_pr.empty() && selections.residual_pr.size() != table.rows.size())
    throw IoError(path, "", "some matches have a residual and some have none, expected all or none");
  if (!selections.source_keypoints.empty() && selections.source_keypoints.size() != table.rows.size())
    throw IoError(path, "", "some matches have keypoints and some have none, expected all or none");
  return selections;
}

std::string selections_text(const PairSelections& selections, const std::vector<std::string>& methods) {
  std::vector<std::string> cells = {"source_keypoint", "target_keypoint", "residual_pr"};
  cells.insert(cells.end(), methods.begin(), methods.end());
  std::string text = csv_line(cells);
  const std::size_t rows =
      std::max({selections.source_keypoints.size(), selections.residual_pr.size(), selections.matches});
  const bool has_keypoints = !selections.source_keypoints.empty();
  for (std::size_t row = 0; row < rows; ++row) {
    cells = {has_keypoints ? std::to_string(selections.source_keypoints[row]) : std::string(),
             has_keypoints ? std::to_string(selections.target_keypoints[row]) : std::string(),
             selections.residual_pr.empty() ? std::string() : to_text(selections.residual_pr[row])};
    for (const std::string& method : methods) {
      const auto found = selections.selected.find(method);
      const bool chosen = found != selections.selected.end() &&
                          std::binary_search(found->second.begin(), found->second.end(), static_cast<int>(row));
      cells.emplace_back(chosen ? "1" : "0");
    }
    text += csv_line(cells);
  }
  return text;
}

std::vector<StudyPose> read_poses(const std::string& path) {
  const CsvTable table = read_csv(path);
  if (table.header != kPoseColumns) throw IoError(path, "header", "expected " + csv_line(kPoseColumns));
  std::vector<StudyPose> poses;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto& cells = table.rows[row];
    StudyPose pose{cells[0], cells[1], {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        pose.target_from_source.rotation(i, j) = number_cell(path, row, cells[static_cast<std::size_t>(2 + 4 * i + j)]);
      pose.target_from_source.translation(i) = number_cell(path, row, cells[static_cast<std::size_t>(5 + 4 * i)]);
    }
    poses.push_back(pose);
  }
  return poses;
}

std::string poses_text(const std::vector<StudyPose>& poses) {
  std::string text = csv_line(kPoseColumns);
  for (const StudyPose& pose : poses) {
    std::vector<std::string> cells = {pose.method, pose.stage};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) cells.push_back(to_text(pose.target_from_source.rotation(i, j)));
      cells.push_back(to_text(pose.target_from_source.translation(i)));
    }
    text += csv_line(cells);
  }
  return text;
}

}  // namespace corral
