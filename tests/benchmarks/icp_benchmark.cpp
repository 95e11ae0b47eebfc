// SPDX-License-Identifier: MIT
// icp_benchmark [--csv] [--benchmark_...] [MESH...]
// Dense refinement of a mesh onto its moved and noisy copy, from 5 degrees and 5 pr away, beside the iterative closest
// points of PCL and Open3D: CPU time in one thread, medians of three, and how far each leaves the vertices from the truth
// (root mean square, pr). Without a mesh those of about 90,000 vertices that the default data give.
//   point-to-point   the same rounds over all points and the same limit on both sides; trees are built within the time
//   coarse-to-fine   the same, but ours over samples first
//   default          ours coarse to fine and by planes, with the normals estimated within the time; the others as above

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>

#include "io/mesh/mesh_file.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/nearest_points.h"
#include "kernel/surface/search/resolution.h"
#include "refine/refine_surface.h"
#include "tests/benchmarks/program.h"
#include "tests/benchmarks/ratio_table.h"
#include "tests/benchmarks/workload.h"
#include "tests/peers/icp.h"

namespace corral::benchmarks {
namespace {

namespace fs = std::filesystem;
constexpr double kLimit_pr = 20, kNoise_pr = 0.1, kAngle_deg = 5, kShift_pr = 5;
constexpr int kMostRounds = 30, kRepetitions = 3;

/// A mesh, where it belongs, and where it starts.
struct Task {
  std::string name;
  Mesh source, target;
  Points source_normals, target_normals;
  double resolution;
  RigidTransform truth, start;

  Task(std::string mesh_name, Mesh mesh) : name(std::move(mesh_name)), source(std::move(mesh)) {
    resolution = point_resolution(source.vertices);
    truth = random_motion(source, 1);
    target = add_gaussian_noise(move_mesh(source, truth), kNoise_pr * resolution, 2);
    source_normals = estimate_normals(source);
    target_normals = estimate_normals(target);
    RandomStream random(3);
    const Eigen::Vector3d middle = vertex_centroid(target);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(kAngle_deg * M_PI / 180, random.direction()).toRotationMatrix();
    start = RigidTransform{turn, middle - turn * middle + kShift_pr * resolution * random.direction()} * truth;
  }

  std::string error(const RigidTransform& pose) const {
    return std::to_string(point_error(pose, truth, source.vertices, resolution)->rmse_pr);
  }
};

RefinedSurface refine_ours(const Task& task, const Points& source_normals, const Points& target_normals,
                           const SurfaceOptions& options) {
  const PointTree tree(task.target.vertices);
  NearestTracker tracker(tree);
  const NearestPairs pair = [&](const Points& queries, double limit) -> const PointPairs& {
    return tracker.pair(queries, limit);
  };
  return refine_surface(
      {{task.source.vertices, source_normals}, {task.target.vertices, target_normals}, task.resolution, pair},
      task.start, options);
}

RefinedSurface by_points(const Task& task) {
  SurfaceOptions options;
  options.residual = SurfaceResidual::PointToPoint;
  options.levels = {{kLimit_pr, std::numeric_limits<int>::max(), kMostRounds}};
  return refine_ours(task, task.source_normals, task.target_normals, options);
}

RefinedSurface by_sampled_points(const Task& task) {
  SurfaceOptions options;
  options.residual = SurfaceResidual::PointToPoint;
  return refine_ours(task, task.source_normals, task.target_normals, options);
}

RefinedSurface by_default(const Task& task) {
  return refine_ours(task, estimate_normals(task.source), estimate_normals(task.target), {});
}

std::string error_text(const Task& task, const RefinedSurface& found) {
  return found.target_from_source ? task.error(*found.target_from_source) : to_text(found.status);
}

struct Peer {
  std::string name;
  peers::Icp icp;
};

/// The other libraries that are installed, for one task.
std::vector<Peer> peers_for([[maybe_unused]] const Task& task) {
  std::vector<Peer> found;
#ifdef CORRAL_WITH_PCL
  found.push_back({"pcl", peers::pcl_icp(task.source.vertices, task.target.vertices)});
#endif
#ifdef CORRAL_WITH_OPEN3D
  found.push_back({"open3d", peers::open3d_icp(task.source.vertices, task.target.vertices)});
#endif
  if (found.empty()) found.push_back({});
  return found;
}

void add(RatioTable& table, const Task& task) {
  const auto count_rounds = [](const RefinedSurface& found) {
    std::size_t rounds = 0;
    for (const auto& level : found.levels) rounds += level.size();
    return static_cast<int>(rounds);
  };
  const int rounds = count_rounds(by_points(task));
  for (const Peer& peer : peers_for(task)) {
    std::string peer_error = "-";
    Setup theirs;
    if (peer.icp) {
      const auto align = [icp = peer.icp, &task, rounds] {
        return icp(task.start, kLimit_pr * task.resolution, rounds);
      };
      const peers::IcpResult found = align();
      if (found.rounds != rounds) std::cerr << task.name << ": " << peer.name << " ran " << found.rounds << " rounds\n";
      peer_error = task.error(found.target_from_source);
      theirs = [align]() -> Call { return [align] { benchmark::DoNotOptimize(align().rounds); }; };
    }
    const auto add_way = [&](const char* way, RefinedSurface (*run)(const Task&)) {
      const RefinedSurface found = run(task);
      const std::size_t row = table.add_row({{task.name, std::to_string(task.source.vertices.rows()), way,
                                              std::to_string(count_rounds(found)), error_text(task, found), peer_error},
                                             peer.name});
      const Setup ours = [&task, run]() -> Call {
        return [&task, run] { benchmark::DoNotOptimize(run(task).condition); };
      };
      table.add_side(task.name + "/" + way, ours, row, Side::Ours, kRepetitions);
      if (theirs) table.add_side(task.name + "/" + peer.name, theirs, row, Side::Peer, kRepetitions);
    };
    add_way("point-to-point", by_points);
    add_way("coarse-to-fine", by_sampled_points);
    add_way("default", by_default);
  }
}

std::deque<Task> read_tasks(const std::vector<std::string>& paths, const fs::path& data) {
  std::deque<Task> tasks;
  for (const std::string& path : paths) tasks.emplace_back(fs::path(path).stem().string(), read_mesh(path));
  if (!paths.empty()) return tasks;
  for (const char* name : {"armadillo", "diplodocus"}) {
    const fs::path path = data / "meshes" / (std::string(name) + ".off");
    if (fs::exists(path)) tasks.emplace_back(std::string(name) + "-x4", refined(read_mesh(path.string())));
  }
  const fs::path scene = data / "scenes/rs1_normals.ply";
  if (fs::exists(scene)) tasks.emplace_back("rs1_normals", read_mesh(scene.string()));
  return tasks;
}

int run(const Arguments& arguments) {
  const std::deque<Task> tasks = read_tasks(arguments.words, data_folder(CORRAL_DATA_FOLDER));
  if (tasks.empty()) return no_mesh();
  RatioTable table({"mesh", "vertices", "residual", "rounds", "ours_rmse_pr", "peer_rmse_pr"}, arguments.as_csv);
  for (const Task& task : tasks) add(table, task);
  benchmark::RunSpecifiedBenchmarks(&table);
  return 0;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  return corral::benchmarks::run_program("icp_benchmark", argc, argv, corral::benchmarks::run);
}
