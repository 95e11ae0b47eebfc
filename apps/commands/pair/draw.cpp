// SPDX-License-Identifier: MIT
// corral draw: pictures of a pair, its matches or its alignment.
#include <filesystem>
#include <numeric>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/picture/pair_picture.h"
#include "apps/runtime/progress.h"
#include "io/disk/file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"

namespace corral {
namespace {

struct Settings {
  std::string source, target, matches, output;
  TruthSettings truth;
  std::vector<std::string> groups, poses;
  double threshold_pr = 4;
  int width = 1600;
};

/// "group_gc.csv" and "pose_gc.txt", as corral run names them, are of gc; another file goes by its own name.
std::string title_of(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  for (const std::string prefix : {"group_", "pose_"})
    if (name.rfind(prefix, 0) == 0 && name.size() > prefix.size()) return name.substr(prefix.size());
  return name;
}

void check(const Settings& settings) {
  check_threshold(settings.threshold_pr);
  if (settings.matches.empty() == settings.poses.empty()) throw UsageError("expected either --matches or --pose");
  if (settings.matches.empty() && !settings.groups.empty()) throw UsageError("--group needs --matches");
  if (settings.width < 200 || settings.width > 3000) throw UsageError("--width: expected 200 to 3000 pixels");
  if (std::filesystem::path(settings.output).extension() != ".png")
    throw UsageError("--output " + settings.output + ": expected a name that ends in .png");
  keep_inputs({settings.source, settings.target, settings.matches, settings.truth.file}, {settings.output});
  check_writable(settings.output);
}

/// Throws IoError where a match is not at its vertex: the table belongs to other meshes.
void check_vertices(const CorrespondenceSet& matches, const PairScene& scene, const std::string& path) {
  const auto check = [&](const Points& points, const Indices& keypoints, const Points& vertices, const char* side) {
    for (std::size_t i = 0; i < keypoints.size(); ++i) {
      const bool is_vertex = keypoints[i] >= 0 && keypoints[i] < vertices.rows();
      const auto row = static_cast<Eigen::Index>(i);
      if (!is_vertex || !((vertices.row(keypoints[i]) - points.row(row)).norm() <= 0.01 * matches.resolution))
        throw IoError(path, "match " + std::to_string(i + 1),
                      "is not at the vertex " + std::to_string(keypoints[i]) + " of the " + side +
                          ", expected the two meshes that were matched");
    }
  };
  check(matches.source_points, matches.source_keypoints, scene.source.mesh.vertices, "source");
  check(matches.target_points, matches.target_keypoints, scene.target.mesh.vertices, "target");
}

Image draw_groups(PairScene& scene, const Settings& settings) {
  const CorrespondenceSet matches = read_matches(settings.matches);
  check_vertices(matches, scene, settings.matches);
  scene.source_points = matches.source_points;
  scene.target_points = matches.target_points;
  if (scene.truth) scene.correct = label_correct(matches, *scene.truth, settings.threshold_pr);
  std::vector<DrawnGroup> groups;
  for (const std::string& path : settings.groups)
    groups.push_back({title_of(path), read_group_of(path, matches.size()).selected});
  if (groups.empty()) {
    groups.push_back({"all matches", Indices(static_cast<std::size_t>(matches.size()))});
    std::iota(groups[0].selected.begin(), groups[0].selected.end(), 0);
  }
  const int columns = groups.size() == 1 ? 1 : 2;
  return contact_sheet(match_pictures(scene, groups, settings.width / columns), columns);
}

Image draw_poses(PairScene& scene, const Settings& settings) {
  std::vector<DrawnPose> poses;
  for (const std::string& path : settings.poses) poses.push_back({title_of(path), read_pose(path)});
  if (!scene.truth) scene.truth = poses.front().target_from_source;
  const int columns = static_cast<int>(poses.size());
  return contact_sheet(alignment_pictures(scene, poses, settings.width / columns), columns);
}

int draw(const Settings& settings) {
  check(settings);
  Progress progress(2);
  progress.begin("surfaces");
  PairScene scene;
  if (!settings.truth.empty()) scene.truth = read_truth(settings.truth);
  scene.source = painted_surface(read_input(settings.source));
  scene.target = painted_surface(read_input(settings.target));
  progress.begin("picture");
  const Image picture = settings.poses.empty() ? draw_groups(scene, settings) : draw_poses(scene, settings);
  write_file(settings.output, png_bytes(picture));
  return kOk;
}

}  // namespace

void add_draw(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("draw", "A picture of the matches between two meshes, or of their alignment");
  auto settings = std::make_shared<Settings>();
  command->add_option("source", settings->source, "Source mesh (a model)")->type_name("FILE")->required();
  command->add_option("target", settings->target, "Target mesh (a scene)")->type_name("FILE")->required();
  command->add_option("--matches", settings->matches, "Table of matches: draws them between the two meshes")
      ->type_name("FILE");
  command->add_option("--group", settings->groups, "Selection from it; several give a sheet of pictures")
      ->type_name("FILE");
  command
      ->add_option("--pose", settings->poses,
                   "Draws the source aligned with the target by this pose; several side by side")
      ->type_name("FILE");
  add_truth_options(*command, settings->truth,
                    ": correct matches are green, incorrect ones red, missed ones faint, and both meshes are seen from "
                    "the same side");
  command->add_option("--threshold-pr", settings->threshold_pr, "Residual up to which a match is correct")
      ->capture_default_str();
  command->add_option("--width", settings->width, "Width of the picture in pixels")->capture_default_str();
  command->add_option("-o,--output", settings->output, "The picture (PNG)")->type_name("FILE")->required();
  command->footer(
      "Examples, with the files of 'corral run model.ply scene.ply --truth truth.txt -o results':\n"
      "  corral draw model.ply scene.ply --matches results/matches.csv --group results/group_gc.csv --truth truth.txt "
      "-o "
      "gc.png\n"
      "  corral draw model.ply scene.ply --matches results/matches.csv --group results/group_*.csv -o all.png\n"
      "  corral draw model.ply scene.ply --pose results/pose_gc.txt -o aligned.png");
  command->callback([settings, &action] { action = [settings] { return draw(*settings); }; });
}

}  // namespace corral
