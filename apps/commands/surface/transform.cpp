// SPDX-License-Identifier: MIT
// corral transform: poses from one layout to another, inverted, composed, and applied to a mesh.
#include <Eigen/Geometry>
#include <algorithm>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/mesh/perturbation.h"

namespace corral {
namespace {

constexpr auto kLayouts = choice_names(TransformLayout());

struct Settings {
  std::string pose, layout = kLayouts[0], key, mesh, output;
  std::vector<std::string> then;
  bool inverse = false, json = false;
};

TransformLayout layout_of(const std::string& name) {
  return static_cast<TransformLayout>(std::find(kLayouts.begin(), kLayouts.end(), name) - kLayouts.begin());
}

void check_output(const Settings& settings) {
  if (settings.output.empty()) return;
  std::vector<std::string> inputs = settings.then;
  inputs.insert(inputs.end(), {settings.pose, settings.mesh});
  keep_inputs(inputs, {settings.output});
  if (!settings.mesh.empty()) check_ply_name(settings.output);
  check_writable(settings.output);
}

/// The poses one after the other, then the inverse of the whole.
RigidTransform composed(const Settings& settings) {
  RigidTransform target_from_source = read_pose(settings.pose);
  for (const std::string& next : settings.then) target_from_source = read_pose(next) * target_from_source;
  return settings.inverse ? target_from_source.inverse() : target_from_source;
}

Json in_json(const RigidTransform& transform) {
  const Eigen::AngleAxisd turn(transform.rotation);
  const Eigen::Vector3d& t = transform.translation;
  constexpr double kDegrees = 57.295779513082320877;
  return {{"target_from_source", to_json(transform)},
          {"rotation_deg", turn.angle() * kDegrees},
          {"axis", {turn.axis()(0), turn.axis()(1), turn.axis()(2)}},
          {"translation", {t(0), t(1), t(2)}},
          {"translation_length", t.norm()}};
}

void write_moved(const Settings& settings, const RigidTransform& target_from_source) {
  const Mesh moved = move_mesh(read_input(settings.mesh), target_from_source);
  write_mesh(settings.output, moved);
  if (moved.sensor)
    say("note: " + settings.output + ": PLY has no place for that of the sensor, which is now " +
        to_text(moved.sensor->x()) + "," + to_text(moved.sensor->y()) + "," + to_text(moved.sensor->z()));
}

int transform(const Settings& settings) {
  if (!settings.mesh.empty() && settings.output.empty()) throw UsageError("--apply: needs --output, a PLY file");
  check_output(settings);
  const RigidTransform target_from_source = composed(settings);
  const auto text = [&] {
    try {
      return transform_text(target_from_source, layout_of(settings.layout), settings.key);
    } catch (const InvalidInput& error) {
      throw UsageError("--key for --to " + settings.layout + ": " + error.what());
    }
  };
  if (!settings.mesh.empty())
    write_moved(settings, target_from_source);
  else if (!settings.output.empty() || !settings.json)
    put(settings.output, text());
  if (settings.json) put("", in_json(target_from_source));
  return kOk;
}

}  // namespace

void add_transform(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "transform", "Poses in the field's layouts: converts, inverts, composes and applies them to a mesh");
  auto settings = std::make_shared<Settings>();
  command->add_option("pose", settings->pose, "The pose")->type_name("FILE[:KEY]")->required();
  command
      ->add_option(
          "--compose", settings->then,
          "A pose that follows; several in the order in which they move a point: POSE first, then each of them")
      ->type_name("FILE[:KEY]")
      ->expected(1)
      ->take_all();
  command->add_flag("--inverse", settings->inverse, "The inverse of the result");
  command->add_option("--to", settings->layout, "Layout that is written")
      ->check(CLI::IsMember(std::vector<std::string>(kLayouts.begin(), kLayouts.end())))
      ->capture_default_str();
  command->add_option("--key", settings->key,
                      "Name of the pose in what is written: a time (tum, default 0), SOURCE,TARGET (log, default 1,0), "
                      "a file (conf, default source.ply), an image (bop, default 0)");
  auto* mesh =
      command->add_option("--apply", settings->mesh, "Moves this mesh or point cloud instead of writing the pose")
          ->type_name("FILE");
  mesh->excludes("--to")->excludes("--key");
  command
      ->add_option("-o,--output", settings->output,
                   "Where the pose goes (default: standard output), or with --apply the moved mesh (PLY)")
      ->type_name("FILE");
  command->add_flag("--json", settings->json,
                    "The result as JSON on standard output: matrix, angle, axis, translation");
  command->footer(
      "Layouts that are read, told by the content:\n"
      "  4x4 or 3x4 matrix, in one line or several; commas, semicolons and brackets (numpy, MATLAB, JSON) may be "
      "there\n"
      "  TUM         time tx ty tz qx qy qz qw, also without the time; frame -> world\n"
      "  KITTI       12 numbers a line; frame 0, 1, ... -> world\n"
      "  .log        Redwood, 3DMatch: 'i j n' with a 4x4 matrix below it, fragment j -> fragment i\n"
      "  .conf       Stanford: bmesh FILE tx ty tz qx qy qz qw; scan -> world\n"
      "  .json       BOP's scene_gt.json (key IMAGE/INSTANCE, model -> camera), or matrices by name\n"
      "FILE:KEY names one of several poses. KEY is 'source' (into the world of the file) or 'source,target': 3,0 is "
      "the\n"
      "pose under '0 3 n' of a .log, and 0,3 its inverse; of KITTI, TUM and .conf, 3,7 maps frame 3 into frame 7.\n"
      "Every option that takes a pose, such as --truth, and the column truth of pairs.csv take the same names.\n"
      "Examples:\n  corral transform gt.log:3,0 -o truth.txt\n"
      "  corral transform poses.txt:3,7 --to tum\n"
      "  corral transform bun.conf:bun045.ply,bun000.ply --apply bun045.ply -o moved.ply\n"
      "  corral transform b_from_a.txt --compose c_from_b.txt -o c_from_a.txt\n"
      "  corral transform truth.txt --inverse --json");
  command->callback([settings, &action] { action = [settings] { return transform(*settings); }; });
}

}  // namespace corral
