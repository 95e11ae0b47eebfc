// SPDX-License-Identifier: MIT
#include "apps/report/pair_gallery.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

#include "apps/picture/pair_picture.h"
#include "apps/report/figure/method_style.h"
#include "apps/report/study_figures.h"
#include "apps/runtime/text_table.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

/// The first record of every pair that has selections, by name.
std::map<std::string, GalleryPair> pairs_of(const std::vector<StudyFolder>& runs) {
  std::map<std::string, GalleryPair> pairs;
  for (const StudyFolder& run : runs)
    for (const StudyRecord& record : run.records) {
      const GalleryPair pair{&run, &record};
      const auto found = run.pairs.find(pair.name());
      if (!record.selection.empty() && found != run.pairs.end() && found->second.has_surfaces())
        pairs.emplace(pair.name(), pair);
    }
  return pairs;
}

double right_share(const GalleryPair& pair) {
  const StudyRecord& record = *pair.record;
  return record.true_matches.value_or(0) / std::max(1.0, static_cast<double>(record.matches.value_or(0)));
}

const ExperimentInfo& experiment_of(const GalleryPair& pair) {
  for (const ExperimentInfo& info : pair.run->experiments)
    if (info.name == pair.record->experiment) return info;
  throw IoError(pair.run->folder + "/records.csv", "",
                "experiment '" + pair.record->experiment + "' is not in manifest.json");
}

Points vertices_at(const Mesh& mesh, const Indices& rows, const std::string& path) {
  Points points(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] >= mesh.vertices.rows())
      throw IoError(path, "", "has no vertex " + std::to_string(rows[i]) + " that the selections name");
    points.row(static_cast<Eigen::Index>(i)) = mesh.vertices.row(rows[i]);
  }
  return points;
}

std::string label_of(const ExperimentInfo& info, const std::string& method) {
  return method_styles({method}, info.titles).at(method).label;
}

std::vector<DrawnGroup> groups_of(const ExperimentInfo& info, const PairSelections& selections) {
  std::vector<DrawnGroup> groups;
  for (const std::string& method : info.methods) {
    const auto found = selections.selected.find(method);
    if (found != selections.selected.end()) groups.push_back({label_of(info, method), found->second});
  }
  Indices all(selections.source_keypoints.size());
  std::iota(all.begin(), all.end(), 0);
  groups.push_back({"all matches", all});
  return groups;
}

/// The poses of every grouper, one row each; a stage that no grouper has is left out.
class PoseGrid {
 public:
  PoseGrid(const GalleryPair& pair, const std::vector<StudyPose>& poses) : info_(experiment_of(pair)) {
    for (const StudyPose& pose : poses) poses_[{pose.method, pose.stage}] = pose.target_from_source;
    for (const StudyRecord& record : pair.run->records)
      if (record.experiment == pair.record->experiment && record.selection == pair.record->selection &&
          record.level == pair.record->level)
        for (const auto& [stage, scores] : {std::pair<std::string, PoseScores>{"initial", record.initial},
                                            {"refined", record.refined},
                                            {"dense", record.dense}})
          errors_[{record.method, stage}] = scores.mean_error_pr;
  }

  std::vector<std::string> stages() const {
    std::vector<std::string> stages;
    for (const std::string stage : {"initial", "refined", "dense"})
      if (std::any_of(poses_.begin(), poses_.end(), [&](const auto& pose) { return pose.first.second == stage; }))
        stages.push_back(stage);
    return stages;
  }

  DrawnPose at(const std::string& method, const std::string& stage) const {
    const auto pose = poses_.find({method, stage});
    std::string title = label_of(info_, method) + ", " +
                        (stage == "dense"     ? "dense refinement"
                         : stage == "initial" ? "initial fit"
                                              : "refined");
    if (pose == poses_.end()) return {title + ": no pose", std::nullopt};
    const auto error = errors_.find({method, stage});
    if (error != errors_.end() && error->second) title += ": mean error " + fixed(error->second, 2) + " pr";
    return {title, pose->second};
  }

 private:
  using Key = std::pair<std::string, std::string>;  // method, stage
  const ExperimentInfo& info_;
  std::map<Key, RigidTransform> poses_;
  std::map<Key, std::optional<double>> errors_;
};

std::string expected_pair(const std::string& name, const std::map<std::string, GalleryPair>& pairs) {
  std::vector<std::string> names;
  for (const auto& [full, pair] : pairs) {
    names.push_back(pair.record->pair);
    names.push_back(full);
  }
  const std::string nearest = nearest_name(name, names);
  const std::string such_as = nearest.empty() && !names.empty() ? names.back() : nearest;
  return "a pair with selections" + (such_as.empty() ? "" : ", such as " + such_as);
}

}  // namespace

std::vector<GalleryPair> choose_gallery(const std::vector<StudyFolder>& runs, const std::vector<std::string>& names) {
  const std::map<std::string, GalleryPair> pairs = pairs_of(runs);
  std::vector<GalleryPair> chosen;
  for (const std::string& name : names) {
    const std::size_t before = chosen.size();
    for (const auto& [full, pair] : pairs)
      if (full == name || pair.record->pair == name) chosen.push_back(pair);
    if (chosen.size() == before) throw InvalidInput("report", "--pairs", name, expected_pair(name, pairs));
  }
  if (!names.empty()) return chosen;
  std::map<std::string, std::vector<GalleryPair>> by_dataset;
  for (const auto& [full, pair] : pairs) by_dataset[pair.record->dataset].push_back(pair);
  for (auto& [dataset, members] : by_dataset) {
    std::stable_sort(members.begin(), members.end(),
                     [](const GalleryPair& a, const GalleryPair& b) { return right_share(a) < right_share(b); });
    chosen.push_back(members[(members.size() - 1) / 2]);
  }
  return chosen;
}

std::vector<FileContent> draw_gallery_pair(const GalleryPair& pair) {
  constexpr int kWidth = 1600, kCell = 1000, kColumn = 600;  // pixels: one picture, one of a sheet, one pose
  const ExperimentInfo& info = experiment_of(pair);
  const StudyPair& files = pair.run->pairs.at(pair.name());
  const std::string path = (std::filesystem::path(pair.run->folder) / pair.record->selection.str()).string();
  const PairSelections selections = read_selections(path);
  PairScene scene;
  scene.source = painted_surface(read_mesh(files.source));
  scene.target = painted_surface(read_mesh(files.target));
  if (!files.truth.empty()) scene.truth = read_transform(files.truth);
  scene.source_points = vertices_at(scene.source.mesh, selections.source_keypoints, files.source);
  scene.target_points = vertices_at(scene.target.mesh, selections.target_keypoints, files.target);
  for (const double residual : selections.residual_pr) scene.correct.push_back(residual <= info.threshold_pr);
  const std::vector<DrawnGroup> groups = groups_of(info, selections);
  const std::string base = file_name_part(pair.record->dataset) + "-" + file_name_part(pair.record->pair) + "-";
  std::vector<FileContent> pictures = {
      {base + "matches.png", png_bytes(contact_sheet(match_pictures(scene, groups, kCell), 2))}};
  const std::vector<Image> singles = match_pictures(scene, groups, kWidth);
  for (std::size_t i = 0; i < groups.size(); ++i)
    pictures.push_back({base + file_name_part(groups[i].title) + ".png", png_bytes(singles[i])});
  const PoseGrid grid(pair, read_poses(std::filesystem::path(path).replace_extension(".poses.csv").string()));
  const std::vector<std::string> stages = grid.stages();
  std::vector<DrawnPose> poses;
  for (const std::string& method : info.methods)
    for (const std::string& stage : stages) poses.push_back(grid.at(method, stage));
  if (!poses.empty())
    pictures.push_back({base + "aligned.png", png_bytes(contact_sheet(alignment_pictures(scene, poses, kColumn),
                                                                      static_cast<int>(stages.size())))});
  return pictures;
}

}  // namespace corral
