// SPDX-License-Identifier: MIT
// corral scan: what a range scanner would see of a mesh, and its pose.
#include <cmath>
#include <optional>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/scan/range_scan.h"
#include "kernel/surface/scan/visibility.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

struct Settings {
  std::string mesh, output, truth, view = "1/8";
  std::optional<std::string> from;
  double spacing_pr = 1, noise_pr = 0;
  RangeScanOptions options;
  int threads = 0;
  bool json = false;
};

RangeSensor sensor_of(const Settings& settings, const Mesh& mesh) {
  if (settings.from) {
    RangeSensor sensor;
    sensor.position = parse_vector("--from", *settings.from);
    sensor.target = bounding_box(mesh.vertices).middle().transpose();
    return sensor;
  }
  const std::size_t slash = std::min(settings.view.find('/'), settings.view.size());
  const auto number = parse_int(settings.view.substr(0, slash));
  const auto count = parse_int(settings.view.substr(std::min(slash + 1, settings.view.size())));
  if (!number || !count || *number < 1 || *number > *count || *count > 1000000)
    throw UsageError("--view: found '" + settings.view + "', expected I/N with I in 1 .. N");
  return ring_sensor(mesh, static_cast<int>(*number) - 1, static_cast<int>(*count));
}

void check(const Settings& settings) {
  if (!(settings.spacing_pr > 0) || !std::isfinite(settings.spacing_pr))
    throw UsageError("--spacing-pr: expected a finite length above zero");
  if (!(settings.noise_pr >= 0) || !std::isfinite(settings.noise_pr))
    throw UsageError("--noise-pr: expected a length of at least 0");
  if (!(settings.options.grazing_deg > 0 && settings.options.grazing_deg <= 90))
    throw UsageError("--grazing-deg: expected an angle above 0 and up to 90");
  check_ply_name(settings.output);
  keep_inputs({settings.mesh}, {settings.output, settings.truth});
}

int scan(const Settings& settings) {
  check(settings);
  Mesh mesh = read_input(settings.mesh);
  if (mesh.triangles.rows() == 0)
    throw IoError(settings.mesh, "",
                  "has no faces, expected a surface ('corral triangulate' gives faces to a single view)");
  const RangeSensor sensor = sensor_of(settings, mesh);
  const ParallelFor parallel = workers(settings.threads);
  RangeScanOptions options = settings.options;
  const double resolution = point_resolution(mesh.vertices, parallel);
  options.spacing = settings.spacing_pr * resolution / kScanResolution;
  options.noise = settings.noise_pr * resolution;
  const SurfaceTree surface(std::move(mesh));
  const PosedSurfaces scene{{&surface, {}}};
  const RangeScan seen = scan_range(scene, sensor, options, parallel);
  const Mesh view = triangulated(seen);
  std::vector<FileContent> files{{settings.output, ply_text(view)}};
  if (!settings.truth.empty()) files.push_back({settings.truth, transform_text(seen.sensor_from_world)});
  write_files(files);
  const double occlusion = measure_visibility(scene, seen).front().occlusion;
  say(settings.output + ": " + std::to_string(view.vertices.rows()) + " points, " +
      std::to_string(view.triangles.rows()) + " faces, " + fixed(100 * (1 - occlusion), 1) + " % of the surface");
  if (settings.json)
    put("", Json{{"vertices", view.vertices.rows()},
                 {"faces", view.triangles.rows()},
                 {"mesh_resolution", resolution},
                 {"view_resolution", point_resolution(view.vertices, parallel)},
                 {"occlusion", occlusion},
                 {"view_from_mesh", to_json(seen.sensor_from_world)}});
  return kOk;
}

}  // namespace

void add_scan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("scan", "What a range scanner sees of a mesh, with the exact pose of the view");
  auto settings = std::make_shared<Settings>();
  command->add_option("mesh", settings->mesh, "Mesh with faces")->type_name("FILE")->required();
  command
      ->add_option("-o,--output", settings->output,
                   "The view (PLY) with faces, in the frame of the sensor: at the origin, looking along -z")
      ->type_name("FILE")
      ->required();
  auto* view = command
                   ->add_option("--view", settings->view,
                                "The I-th of N sensors on a ring around the y axis that rises and falls by 25 degrees")
                   ->type_name("I/N")
                   ->capture_default_str();
  command->add_option("--from", settings->from, "Position of the sensor, mesh units; it looks at the middle, z is up")
      ->type_name("X,Y,Z")
      ->excludes(view);
  command->add_option("--truth", settings->truth, "Where the pose goes: view_from_mesh, a 4x4 matrix")
      ->type_name("FILE");
  command
      ->add_option("--spacing-pr", settings->spacing_pr,
                   "Resolution of the view in pr of the mesh, to within a few hundredths")
      ->capture_default_str();
  command->add_option("--noise-pr", settings->noise_pr, "Deviation of normal noise along each ray, pr of the mesh")
      ->capture_default_str();
  command
      ->add_option("--grazing-deg", settings->options.grazing_deg,
                   "A surface whose normal is further from the ray than this is not seen")
      ->capture_default_str();
  command->add_option("--seed", settings->options.seed, "Seed of the noise")->capture_default_str();
  add_threads(*command, settings->threads);
  command->add_flag("--json", settings->json, "Size, resolution, occlusion and pose as JSON on standard output");
  command->footer(
      "Examples:\n  corral scan bunny.off -o front.ply --truth front.txt\n"
      "  corral scan bunny.off --view 2/8 --noise-pr 0.1 -o side.ply --truth side.txt\n"
      "  corral scan chair.ply --from 0,-3000,1500 --spacing-pr 0.5 -o view.ply\n"
      "  corral run bunny.off front.ply --truth front.txt");
  command->callback([settings, &action] { action = [settings] { return scan(*settings); }; });
}

}  // namespace corral
