// SPDX-License-Identifier: MIT
// corral align: views of one object into one frame.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/align/align_view_set.h"
#include "apps/align/alignment_files.h"
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "kernel/error.h"
#include "kernel/surface/scan/view_side.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> views;
  std::string output, poses;
  SensorSettings sensor;
  int threads = 0;
  bool json = false;
};

std::vector<std::string> view_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    names.push_back(view_name(path));
    if (std::count(names.begin(), names.end(), names.back()) > 1)
      throw UsageError("two views are named '" + names.back() + "', expected a different name for each");
  }
  return names;
}

std::string in_words(const ViewOptions& side) {
  const Eigen::Vector3d vector = side.direction.value_or(side.sensor);
  char text[96];
  std::snprintf(text, sizeof text, "%.3g,%.3g,%.3g", vector.x(), vector.y(), vector.z());
  return std::string(side.direction ? "looks along " : "stands at ") + text;
}

/// Where the sensor of each view is taken to be, unless at the origin; and where that sees the back of the surface.
void say_sides(const std::vector<std::string>& paths, const std::vector<Mesh>& meshes, const ViewSet& views,
               bool are_given) {
  for (int view = 0; view < views.size(); ++view) {
    const auto i = static_cast<std::size_t>(view);
    const ViewOptions& side = views.side(view);
    const auto front = front_share(meshes[i], side);
    if (!are_given && (side.direction || !side.sensor.isZero(0)))
      say("note: " + paths[i] + ": the sensor " + in_words(side) +
          (meshes[i].sensor ? ", as the file says" : ", by the side of its faces or normals"));
    if (!front || *front >= 0.5) continue;
    say("warning: " + paths[i] + ": the sensor sees the back of " + fixed(100 * (1 - *front), 0) +
        " % of the faces or normals in the file" +
        (meshes[i].sensor ? "" : ", by which it " + in_words(view_side(meshes[i]))));
  }
}

int align(const Settings& settings) {
  if (settings.views.size() < 2) throw UsageError("expected at least two views");
  const std::vector<std::string> names = view_names(settings.views);
  std::optional<ViewOptions> sensor;
  if (settings.sensor.are_given()) sensor = view_options(settings.sensor);
  std::vector<std::string> inputs = settings.views, outputs = {settings.output + "/pairs.csv"};
  inputs.push_back(settings.poses);
  for (const std::string& name : names) outputs.push_back(settings.output + "/" + name + ".xf");
  if (!settings.poses.empty())
    for (const std::string& pose : pose_names(settings.poses)) inputs.push_back(pose);
  std::error_code none;
  for (const auto& old : std::filesystem::directory_iterator(settings.output + "/poses", none))
    outputs.push_back(old.path().string());
  keep_inputs(inputs, outputs);
  std::vector<Mesh> meshes;
  for (const std::string& path : settings.views) meshes.push_back(read_input(path));
  std::vector<ViewPair> poses;
  if (!settings.poses.empty()) poses = read_view_pairs(settings.poses, names);
  make_folder(settings.output + "/poses");
  check_writable(settings.output + "/pairs.csv");

  const ParallelFor parallel = workers(settings.threads);
  auto progress = std::make_unique<Progress>(align_steps(static_cast<int>(meshes.size())));
  const ViewSet views(meshes, sensor, parallel);
  say_sides(settings.views, meshes, views, sensor.has_value());
  const AlignedViews aligned =
      settings.poses.empty()
          ? align_view_set(views, {}, parallel,
                           [&](const std::string& what, double steps) { progress->begin(what, steps); })
          : align_view_set(views, poses, {});
  progress.reset();
  write_files(alignment_files(settings.output, names, aligned));
  for (std::size_t old = aligned.pairs.size() + 1; std::filesystem::exists(pose_file(settings.output, old)); ++old)
    remove_file(pose_file(settings.output, old));  // of an earlier run
  if (settings.json)
    put("", to_json(names, aligned));
  else
    put("", alignment_text(names, aligned));
  const int parts = 1 + *std::max_element(aligned.part.begin(), aligned.part.end());
  if (parts > 1)
    say("note: the views form " + std::to_string(parts) + " unconnected parts; each has the frame of its first view");
  if (parts == views.size())
    say("hint: no two views were connected: the result depends on where the sensor stood; give --sensor or "
        "--direction" +
        std::string(sensor ? ", or try the opposite one" : ""));
  if (!aligned.converged) say("note: the pose graph did not converge");
  return kOk;
}

}  // namespace

void add_align(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("align", "Views of one object into one frame, with a verdict on every pair");
  auto settings = std::make_shared<Settings>();
  command
      ->add_option("views", settings->views,
                   "Range scans; lists of points (.txt too) get faces as by 'corral triangulate'")
      ->type_name("FILE")
      ->required();
  command->add_option("-o,--output", settings->output, "Folder for <view>.xf (world from view), pairs.csv and poses/")
      ->type_name("FOLDER")
      ->required();
  command
      ->add_option("--poses", settings->poses,
                   "Judge these poses instead of searching for some: source,target,transform[,weight] by view name")
      ->type_name("FILE");
  add_sensor_options(*command, settings->sensor);
  command->add_option("--threads", settings->threads, "0: as many as there are processors")->capture_default_str();
  command->add_flag("--json", settings->json, "Poses, pairs and parts as JSON on standard output");
  command->footer(
      "Verdicts: agrees (other pairs lead to the same pose), contradicts (they lead to another one), unchecked (no\n"
      "other pairs connect the two views). off pr: distance between the source points under the pose of the pair and\n"
      "under the alignment. in front %: share of the points of a view that lie in front of what the other saw, the\n"
      "larger of the two; almost none under a correct pose.\n"
      "Examples:\n  corral align view*.txt -o aligned\n"
      "  corral align scan*.ply --direction 0,0,-1 -o aligned --json\n"
      "  corral align view*.txt --poses aligned/pairs.csv -o judged");
  command->callback([settings, &action] { action = [settings] { return align(*settings); }; });
}

}  // namespace corral
