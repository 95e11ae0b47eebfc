// SPDX-License-Identifier: MIT
// corral info: counts, resolution and warnings of a mesh.
#include <cmath>

#include "apps/commands/commands.h"
#include "apps/pair/surface_warnings.h"
#include "apps/runtime/output.h"
#include "io/mesh/mesh_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/mesh/half_edges.h"
#include "kernel/surface/mesh/topology.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

struct MeshInfo {
  std::string path;
  int vertices = 0, faces = 0;
  Topology topology;
  HalfEdgeReport half_edges;
  std::optional<PointSpacing> spacing;
  NormalGuide normals = NormalGuide::Origin;
  Eigen::RowVector3d extent = Eigen::RowVector3d::Zero();
  std::vector<std::string> warnings;
};

void add_warnings(MeshInfo& info) {
  const auto warn = [&](int count, const std::string& text) {
    if (count > 0) info.warnings.push_back(std::to_string(count) + " " + text);
  };
  if (info.normals == NormalGuide::Origin)
    info.warnings.push_back(
        "no faces, normals or sensor were read: the normals of the cloud will point to the origin; 'corral "
        "triangulate' gives faces to a range scan");
  warn(info.topology.duplicate_vertices, "duplicate vertices: they count once for pr");
  warn(info.topology.isolated_vertices, "vertices without a face");
  warn(info.topology.degenerate_faces, "faces without area: left out of components, boundary and edges");
  warn(info.topology.misoriented_faces, "faces wound against the others: normals will have the wrong sign there");
  warn(info.topology.non_manifold_edges, "non-manifold edges: more than two faces meet there");
  warn(info.topology.non_manifold_vertices, "non-manifold vertices: the faces around them are not one fan");
  warn(
      info.half_edges.refused_faces,
      "faces that no half-edge structure can hold: boundary loops are not counted, and the mean edge is of the other faces");
  if (!info.spacing)
    info.warnings.push_back("fewer than 2 distinct vertices, or coordinates too large for distances: no resolution");
}

MeshInfo inspect(const std::string& path) {
  const StoredMesh mesh = read_mesh(path);
  MeshInfo info;
  info.path = path;
  info.vertices = static_cast<int>(mesh.vertices.rows());
  info.faces = static_cast<int>(mesh.triangles.rows());
  info.topology = inspect_topology(mesh);
  info.half_edges = inspect_half_edges(mesh);
  const BoundingBox box = bounding_box(mesh.vertices);
  if (box.diagonal() > 0 && std::isfinite(box.diagonal())) info.spacing = point_spacing(mesh.vertices);
  info.extent = box.high - box.low;
  info.normals = normal_guide(mesh, {});
  info.warnings = mesh.notes;
  add_warnings(info);
  if (info.spacing)
    for (const std::string& warning : surface_warnings(mesh, *info.spacing)) info.warnings.push_back(warning);
  return info;
}

Json to_json(const MeshInfo& info) {
  return {{"path", info.path},
          {"vertices", info.vertices},
          {"faces", info.faces},
          {"components", info.topology.components},
          {"boundary_edges", info.topology.boundary_edges},
          {"boundary_loops", json_or_null(info.half_edges.boundary_loops)},
          {"duplicates", info.topology.duplicate_vertices},
          {"isolated", info.topology.isolated_vertices},
          {"degenerate_faces", info.topology.degenerate_faces},
          {"misoriented_faces", info.topology.misoriented_faces},
          {"non_manifold_edges", info.topology.non_manifold_edges},
          {"non_manifold_vertices", info.topology.non_manifold_vertices},
          {"non_manifold_faces", info.half_edges.refused_faces},
          {"resolution", info.spacing ? Json(info.spacing->resolution) : Json(nullptr)},
          {"median_spacing", info.spacing ? Json(info.spacing->median) : Json(nullptr)},
          {"normals", corral::to_text(info.normals)},
          {"mean_edge_length", info.faces > 0 ? Json(info.half_edges.mean_edge_length) : Json(nullptr)},
          {"extent", {info.extent(0), info.extent(1), info.extent(2)}},
          {"diagonal", info.extent.norm()},
          {"warnings", info.warnings}};
}

std::string to_text(const MeshInfo& info) {
  using corral::to_text;
  const std::optional<int> loops = info.half_edges.boundary_loops;
  std::string text = info.path + "\n  vertices    " + std::to_string(info.vertices) + " (" +
                     std::to_string(info.topology.duplicate_vertices) + " duplicates)\n  faces       " +
                     std::to_string(info.faces) + " in " + std::to_string(info.topology.components) + " components\n" +
                     "  boundary    " + std::to_string(info.topology.boundary_edges) + " edges" +
                     (loops ? " in " + std::to_string(*loops) + " loops" : "") + "\n  resolution  " +
                     (info.spacing ? to_text(info.spacing->resolution) + " mesh units per pr (median " +
                                         to_text(info.spacing->median) + ")"
                                   : "-") +
                     "\n  normals     " + to_text(info.normals) + "\n  mean edge   " +
                     (info.faces > 0 ? to_text(info.half_edges.mean_edge_length) : "-") + "\n  extent      " +
                     to_text(info.extent(0)) + " x " + to_text(info.extent(1)) + " x " + to_text(info.extent(2)) + "\n";
  for (const std::string& warning : info.warnings) text += "  warning     " + warning + "\n";
  return text;
}

struct Settings {
  std::vector<std::string> meshes;
  bool json = false;
};

int info(const Settings& settings) {
  Json list = Json::array();
  std::string text;
  std::size_t failed = 0;
  for (const std::string& path : settings.meshes) {
    try {
      const MeshInfo about = inspect(path);
      list.push_back(to_json(about));
      text += to_text(about);
    } catch (const std::runtime_error& error) {
      ++failed;
      list.push_back({{"path", path}, {"error", error.what()}});
      say(std::string("corral: ") + error.what());
    }
  }
  if (settings.json)
    put("", list);
  else
    put("", text);
  return failed == 0 ? kOk : failed == settings.meshes.size() ? kBadInput : kPartial;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("info", "What a mesh is: counts, components, boundary, resolution, warnings");
  auto settings = std::make_shared<Settings>();
  command->add_option("mesh", settings->meshes, "Mesh or point cloud (" + mesh_endings() + ")")
      ->type_name("FILE")
      ->required();
  command->add_flag("--json", settings->json, "A JSON array, one object per mesh");
  command->footer("Examples:\n  corral info bunny.off\n  corral info --json scans/*.ply");
  command->callback([settings, &action] { action = [settings] { return info(*settings); }; });
}

}  // namespace corral
