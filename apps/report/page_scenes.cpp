// SPDX-License-Identifier: MIT
#include "apps/report/page_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "apps/report/figure/method_style.h"
#include "apps/runtime/json.h"
#include "apps/runtime/progress.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/surface/mesh/simplification.h"

namespace corral {
namespace {

constexpr int kMostVertices = 4000;  // of a mesh on the page: its triangles are numbered in 16 bit

std::string base64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned triple = 0;
    for (std::size_t i = at; i < at + 3; ++i)
      triple = (triple << 8) | (i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[(triple >> shift) & 63U];
  }
  for (std::size_t missing = (3 - bytes.size() % 3) % 3; missing > 0; --missing) text[text.size() - missing] = '=';
  return text;
}

void add_16_bit(std::string& bytes, int value) {  // little-endian
  bytes += static_cast<char>(value & 255);
  bytes += static_cast<char>((value >> 8) & 255);
}

/// 0 .. 65535 from one side of the box to the other, a row after another.
std::string quantized(const Points& points, const BoundingBox& box) {
  std::string bytes;
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = box.high(axis) - box.low(axis);
      const double share = extent > 0 ? (points(row, axis) - box.low(axis)) / extent : 0;
      add_16_bit(bytes, static_cast<int>(std::lround(65535 * std::clamp(share, 0.0, 1.0))));
    }
  return base64(bytes);
}

std::string triangle_text(const Triangles& triangles) {
  std::string bytes;
  for (Eigen::Index face = 0; face < triangles.rows(); ++face)
    for (int corner = 0; corner < 3; ++corner) add_16_bit(bytes, triangles(face, corner));
  return base64(bytes);
}

std::string normal_text(const Points& normals) {
  std::string bytes;
  for (Eigen::Index row = 0; row < normals.rows(); ++row)
    for (int axis = 0; axis < 3; ++axis) bytes += static_cast<char>(std::lround(127 * normals(row, axis)));
  return base64(bytes);
}

std::string float_text(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    const auto single = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &single, sizeof bits);
    add_16_bit(bytes, static_cast<int>(bits & 65535U));
    add_16_bit(bytes, static_cast<int>(bits >> 16));
  }
  return base64(bytes);
}

/// One bit per match, the first in the lowest bit of the first byte.
std::string bit_text(const Indices& rows, std::size_t matches) {
  std::string bytes((matches + 7) / 8, '\0');
  for (const int row : rows) {
    char& byte = bytes[static_cast<std::size_t>(row) / 8];
    byte = static_cast<char>(byte | (1 << (row % 8)));
  }
  return base64(bytes);
}

Json numbers(const Eigen::RowVector3d& vector) { return {vector(0), vector(1), vector(2)}; }

Json numbers(const RigidTransform& transform) {
  Json twelve = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) twelve.push_back(transform.rotation(row, column));
    twelve.push_back(transform.translation(row));
  }
  return twelve;
}

/// The meshes of the page, each once; of the full ones only the last is kept.
class MeshShelf {
 public:
  struct Place {
    int number;
    const Mesh* full;
    BoundingBox box;
  };

  Place put(const std::string& path) {
    if (path.empty() || path != last_path_) {
      last_path_.clear();
      last_ = read_mesh(path);
      if (last_.vertices.rows() == 0) throw IoError(path, "", "no vertices, expected a surface");
      last_path_ = path;
    }
    const BoundingBox box = bounding_box(last_.vertices);
    const auto [known, is_new] = numbers_.emplace(path, static_cast<int>(meshes_.size()));
    if (is_new) {
      const SimplifiedMesh display = simplify_for_display(last_, kMostVertices);
      meshes_.push_back({{"low", numbers(box.low)},
                         {"high", numbers(box.high)},
                         {"vertices", quantized(display.mesh.vertices, box)},
                         {"triangles", triangle_text(display.mesh.triangles)},
                         {"normals", normal_text(display.normals)},
                         {"full", last_.vertices.rows()}});
    }
    return {known->second, &last_, box};
  }
  const Json& meshes() const { return meshes_; }
  /// The text of the meshes from this one on.
  std::size_t bytes_from(std::size_t first) const {
    std::size_t bytes = 0;
    for (std::size_t i = first; i < meshes_.size(); ++i) bytes += compact_json(meshes_[i]).size() + 1;
    return bytes;
  }
  /// Takes the others away again; nothing may be put behind them.
  void keep(std::size_t count) { meshes_.erase(meshes_.begin() + static_cast<std::ptrdiff_t>(count), meshes_.end()); }

 private:
  std::map<std::string, int> numbers_;
  std::string last_path_;
  Mesh last_;
  Json meshes_ = Json::array();
};

std::string keypoint_text(const MeshShelf::Place& place, const Indices& keypoints, const std::string& path) {
  Points points(static_cast<Eigen::Index>(keypoints.size()), 3);
  for (std::size_t row = 0; row < keypoints.size(); ++row) {
    if (keypoints[row] >= place.full->vertices.rows())
      throw IoError(path, "row " + std::to_string(row + 1),
                    "vertex " + std::to_string(keypoints[row]) + " of a mesh of " +
                        std::to_string(place.full->vertices.rows()) + " vertices");
    points.row(static_cast<Eigen::Index>(row)) = place.full->vertices.row(keypoints[row]);
  }
  return quantized(points, place.box);
}

Json scene_of(const StudyFolder& run, const SceneChoice& choice, MeshShelf& shelf) {
  const std::string path = (std::filesystem::path(run.folder) / choice.selection).string();
  const PairSelections selections = read_selections(path);
  const auto pair = run.pairs.find(choice.dataset + "/" + choice.pair);
  if (pair == run.pairs.end()) throw IoError(run.folder, "manifest.json", "does not know the pair " + choice.pair);
  if (selections.source_keypoints.size() != selections.matches)
    throw IoError(path, "", "names no vertices, expected those of a pair with surfaces");
  Json scene;
  for (const bool is_source : {true, false}) {  // one full mesh at a time
    const MeshShelf::Place place = shelf.put(is_source ? pair->second.source : pair->second.target);
    scene[is_source ? "source" : "target"] = place.number;
    scene[is_source ? "source_points" : "target_points"] =
        keypoint_text(place, is_source ? selections.source_keypoints : selections.target_keypoints, path);
  }
  const std::size_t matches = selections.source_keypoints.size();
  scene["resolution"] = pair->second.resolution;
  scene["matches"] = matches;
  scene["residuals"] = selections.residual_pr.empty() ? Json(nullptr) : Json(float_text(selections.residual_pr));
  scene["truth"] = pair->second.truth.empty() ? Json(nullptr) : numbers(read_transform(pair->second.truth));
  scene["selected"] = Json::object();
  for (const auto& [method, rows] : selections.selected) scene["selected"][method] = bit_text(rows, matches);
  scene["poses"] = Json::object();
  const std::string poses = std::filesystem::path(path).replace_extension(".poses.csv").string();
  if (std::filesystem::exists(poses))  // there is none where no method had a pose
    for (const StudyPose& pose : read_poses(poses))
      scene["poses"][pose.method][pose.stage] = numbers(pose.target_from_source);
  return scene;
}

/// The scenes of a level from the least mean F1 of the groupers to the best; those without a score first.
std::vector<SceneChoice> scenes_by_f1(const StudyFolder& run, int number, const ExperimentInfo& experiment,
                                      const std::string& level) {
  struct Tally {
    double sum = 0;
    int count = 0;
  };
  std::map<std::tuple<std::string, std::string, std::string>, Tally> tallies;
  for (const StudyRecord& record : run.records) {
    if (record.experiment != experiment.name || record.level != level || record.selection.empty()) continue;
    const auto pair = run.pairs.find(record.dataset + "/" + record.pair);
    if (pair != run.pairs.end() && !pair->second.has_surfaces()) continue;  // of a table alone there is nothing to show
    Tally& tally = tallies[{record.dataset, record.pair, record.selection}];
    if (is_bound(record.method) || !record.f1) continue;
    tally.sum += *record.f1;
    ++tally.count;
  }
  std::vector<std::pair<double, SceneChoice>> scored;
  for (const auto& [key, tally] : tallies)
    scored.push_back({tally.count > 0 ? tally.sum / tally.count : -1,
                      {number, std::get<0>(key), std::get<1>(key), std::get<2>(key)}});
  std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SceneChoice> scenes;
  for (const auto& [score, scene] : scored) scenes.push_back(scene);
  return scenes;
}

}  // namespace

std::vector<SceneChoice> choose_scenes(const std::vector<StudyFolder>& runs, int most) {
  std::vector<std::vector<SceneChoice>> levels;
  std::size_t longest = 0;
  for (std::size_t number = 0; number < runs.size(); ++number)
    for (const ExperimentInfo& experiment : runs[number].experiments)
      for (const StudyLevel& level : experiment.levels) {
        std::vector<SceneChoice> scenes = scenes_by_f1(runs[number], static_cast<int>(number), experiment, level.label);
        if (scenes.empty()) continue;
        // Median, worst, best, and then in their order.
        std::rotate(scenes.begin(), scenes.begin() + static_cast<std::ptrdiff_t>((scenes.size() - 1) / 2),
                    scenes.begin() + static_cast<std::ptrdiff_t>((scenes.size() + 1) / 2));
        if (scenes.size() > 2) std::rotate(scenes.begin() + 2, scenes.end() - 1, scenes.end());
        longest = std::max(longest, scenes.size());
        levels.push_back(std::move(scenes));
      }
  std::vector<SceneChoice> chosen;
  std::set<std::pair<int, std::string>> seen;
  for (std::size_t round = 0; round < longest; ++round)
    for (const auto& scenes : levels)
      if (round < scenes.size() && static_cast<int>(chosen.size()) < most &&
          seen.emplace(scenes[round].run, scenes[round].selection).second)
        chosen.push_back(scenes[round]);
  return chosen;
}

Json page_scenes(const std::vector<StudyFolder>& runs, const std::vector<SceneChoice>& choices,
                 std::size_t most_bytes) {
  MeshShelf shelf;
  Json scenes = Json::array();
  Progress progress(static_cast<double>(choices.size()));
  for (const SceneChoice& choice : choices) {
    progress.begin("3D: " + choice.pair);
    const std::size_t meshes = shelf.meshes().size();
    Json scene = {
        {"run", choice.run}, {"dataset", choice.dataset}, {"pair", choice.pair}, {"selection", choice.selection}};
    try {
      scene.update(scene_of(runs[static_cast<std::size_t>(choice.run)], choice, shelf));
    } catch (const IoError& error) {
      scene["problem"] = error.what();
    }
    const std::size_t bytes = compact_json(scene).size() + 1 + shelf.bytes_from(meshes);
    if (bytes > most_bytes) {
      shelf.keep(meshes);
      break;
    }
    most_bytes -= bytes;
    scenes.push_back(std::move(scene));
  }
  return {{"meshes", shelf.meshes()}, {"scenes", scenes}};
}

}  // namespace corral
