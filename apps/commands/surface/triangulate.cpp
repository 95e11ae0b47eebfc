// SPDX-License-Identifier: MIT
// corral triangulate: faces for a range scan that is a list of points.
#include <cmath>
#include <optional>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/number_text.h"
#include "kernel/surface/scan/view_triangulation.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

/// Views of two real scanners lose 1 to 14 % of their triangles; with a sensor 45 degrees off, 21 % and more.
constexpr double kManyDropped = 0.2;

struct Settings {
  std::string view, output;
  SensorSettings sensor;
  double longest_edge_pr = ViewOptions().longest_edge_pr, grazing_deg = ViewOptions().grazing_deg;
  bool json = false;
};

ViewOptions triangulation_options(const Settings& settings) {
  ViewOptions options = view_options(settings.sensor);
  options.longest_edge_pr = settings.longest_edge_pr;
  options.grazing_deg = settings.grazing_deg;
  if (!(options.longest_edge_pr > 0) || !std::isfinite(options.longest_edge_pr))
    throw UsageError("--longest-edge-pr: expected a finite length above zero");
  if (!(options.grazing_deg > 0 && options.grazing_deg <= 90))
    throw UsageError("--grazing-deg: expected an angle above 0 and up to 90");
  return options;
}

Json to_json(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json to_json(const Mesh& input, const ViewTriangulation& view, double resolution, const ViewOptions& options) {
  return {{"vertices", input.vertices.rows()},
          {"faces", view.triangles.rows()},
          {"dropped_long", view.dropped_long},
          {"dropped_grazing", view.dropped_grazing},
          {"hidden", view.hidden},
          {"replaced_faces", input.triangles.rows()},
          {"resolution", resolution},
          {"sensor", options.direction ? Json(nullptr) : to_json(options.sensor)},
          {"direction", options.direction ? to_json(*options.direction) : Json(nullptr)},
          {"longest_edge_pr", options.longest_edge_pr},
          {"grazing_deg", options.grazing_deg}};
}

int triangulate(const Settings& settings) {
  ViewOptions options = triangulation_options(settings);
  check_ply_name(settings.output);
  keep_inputs({settings.view}, {settings.output});
  const Mesh input = read_input(settings.view);
  if (!settings.sensor.are_given() && input.sensor) options.sensor = *input.sensor;
  const double resolution = point_resolution(input.vertices);
  const ViewTriangulation view = triangulate_view(input.vertices, resolution, options);
  write_mesh(settings.output, {input.vertices, view.triangles});
  if (input.triangles.rows() > 0)
    say("note: " + std::to_string(input.triangles.rows()) + " faces of " + settings.view + " are replaced");
  say(settings.output + ": " + std::to_string(view.triangles.rows()) + " faces kept, " +
      std::to_string(view.dropped_long) + " long and " + std::to_string(view.dropped_grazing) +
      " grazing ones dropped, " + std::to_string(view.hidden) + " points hidden");
  const double dropped = static_cast<double>(view.dropped_long) + view.dropped_grazing;
  if (dropped > kManyDropped * (dropped + static_cast<double>(view.triangles.rows())))
    say("hint: so many dropped triangles suggest another sensor position (--sensor, --direction), or several views");
  if (settings.json) put("", to_json(input, view, resolution, options));
  return kOk;
}

}  // namespace

void add_triangulate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("triangulate", "Faces for a range scan that is a point cloud seen by one sensor");
  auto settings = std::make_shared<Settings>();
  command->add_option("view", settings->view, "Points of one view; existing faces are replaced")
      ->type_name("FILE")
      ->required();
  command->add_option("-o,--output", settings->output, "The same points with faces (PLY)")
      ->type_name("FILE")
      ->required();
  add_sensor_options(*command, settings->sensor);
  command
      ->add_option("--longest-edge-pr", settings->longest_edge_pr,
                   "A triangle with a longer edge spans a jump in depth, and is dropped")
      ->capture_default_str();
  command
      ->add_option("--grazing-deg", settings->grazing_deg,
                   "A triangle whose normal is further from the ray to the sensor is dropped")
      ->capture_default_str();
  command->add_flag("--json", settings->json, "What was kept and dropped as JSON on standard output");
  command->footer(
      "Examples:\n  corral triangulate scan.xyz -o view.ply\n"
      "  corral triangulate scan.xyz --sensor 0,0,1200 -o view.ply\n"
      "  corral triangulate scan.xyz --direction 0,0,-1 --longest-edge-pr 4 -o view.ply");
  command->callback([settings, &action] { action = [settings] { return triangulate(*settings); }; });
}

}  // namespace corral
