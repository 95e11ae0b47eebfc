// SPDX-License-Identifier: MIT
#include "tests/benchmarks/workload.h"

#include <filesystem>
#include <map>
#include <numeric>

#include "io/mesh/mesh_file.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/benchmarks/our_stages.h"

namespace corral::benchmarks {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kSeed = 1;
constexpr double kNoise_pr = 0.1;

/// `count` of some rows, evenly spread.
Indices spread(const Indices& rows, int count) {
  Indices chosen;
  for (int i = 0; i < count; ++i)
    chosen.push_back(rows[static_cast<std::size_t>(i) * rows.size() / static_cast<std::size_t>(count)]);
  return chosen;
}

/// Keypoints at the largest radius that gives enough of them; if none does, vertices of every kind.
Indices enough_places(const Mesh& mesh, double resolution, int count) {
  for (const double radius_pr : {3.0, 2.0, 1.5}) {
    Indices keypoints = ours::harris(mesh, resolution, radius_pr);
    if (static_cast<int>(keypoints.size()) >= count) return keypoints;
  }
  Indices vertices(static_cast<std::size_t>(mesh.vertices.rows()));
  std::iota(vertices.begin(), vertices.end(), 0);
  return vertices;
}

Descriptors describe(const Mesh& mesh, double resolution, int count) {
  const Indices places = spread(enough_places(mesh, resolution, count), count);
  return ours::shot(mesh, ours::normals(mesh), places, resolution);
}

}  // namespace

Workload::Workload(std::string name, Mesh mesh) : name_(std::move(name)), mesh_(std::move(mesh)) {}

const Mesh& Workload::target() {
  if (!target_)
    target_ = add_gaussian_noise(move_mesh(mesh_, random_motion(mesh_, kSeed)), kNoise_pr * resolution(), kSeed);
  return *target_;
}

double Workload::resolution() {
  if (!resolution_) resolution_ = ours::resolution(mesh_);
  return *resolution_;
}

const Points& Workload::normals() {
  if (!normals_) normals_ = ours::normals(mesh_);
  return *normals_;
}

const Indices& Workload::keypoints() {
  if (!keypoints_) keypoints_ = ours::harris(mesh_, resolution());
  return *keypoints_;
}

const Workload::Features& Workload::features(int count) {
  const auto [place, is_new] = features_.try_emplace(count);
  if (is_new && mesh_.vertices.rows() >= count)
    place->second.emplace(describe(mesh_, resolution(), count), describe(target(), resolution(), count));
  return place->second;
}

Mesh refined(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::RowVector3d> added;
  const auto middle = [&](int a, int b) {
    const auto next = static_cast<int>(mesh.vertices.rows() + static_cast<Eigen::Index>(added.size()));
    const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), next);
    if (is_new) added.push_back((mesh.vertices.row(a) + mesh.vertices.row(b)) / 2);
    return place->second;
  };
  Mesh finer;
  finer.triangles.resize(4 * mesh.triangles.rows(), 3);
  for (Eigen::Index row = 0; row < mesh.triangles.rows(); ++row) {
    const int a = mesh.triangles(row, 0), b = mesh.triangles(row, 1), c = mesh.triangles(row, 2);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.triangles.middleRows<4>(4 * row) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
  }
  finer.vertices.resize(mesh.vertices.rows() + static_cast<Eigen::Index>(added.size()), 3);
  finer.vertices.topRows(mesh.vertices.rows()) = mesh.vertices;
  for (std::size_t i = 0; i < added.size(); ++i)
    finer.vertices.row(mesh.vertices.rows() + static_cast<Eigen::Index>(i)) = added[i];
  return add_gaussian_noise(finer, kNoise_pr * ours::resolution(finer), kSeed);
}

std::vector<Workload> read_workloads(const std::vector<std::string>& paths, const std::string& data_folder) {
  std::vector<Workload> workloads;
  for (const std::string& path : paths) workloads.emplace_back(fs::path(path).stem().string(), read_mesh(path));
  if (!paths.empty()) return workloads;
  for (const char* name : {"meshes/bunny00.off", "meshes/refined_elephant.off", "scenes/rs1_normals.ply"}) {
    const fs::path path = fs::path(data_folder) / name;
    if (!fs::exists(path)) continue;
    Mesh mesh = read_mesh(path.string());
    if (path.extension() == ".off") workloads.emplace_back(path.stem().string() + "-x4", refined(mesh));
    workloads.emplace_back(path.stem().string(), std::move(mesh));
  }
  return workloads;
}

}  // namespace corral::benchmarks
