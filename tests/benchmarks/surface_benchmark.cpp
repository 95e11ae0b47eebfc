// SPDX-License-Identifier: MIT
// surface_benchmark [--csv] [--benchmark_...] [MESH...]
// CPU time of every stage from a mesh to matches, ours beside the same stage of other libraries, one thread each: medians
// of five, and their ratio. Without a mesh those of the default data, looked for in build/data or where the environment
// variable CORRAL_DATA says.

#include <benchmark/benchmark.h>

#include <functional>
#include <memory>

#include "tests/benchmarks/our_stages.h"
#include "tests/benchmarks/program.h"
#include "tests/benchmarks/ratio_table.h"
#include "tests/benchmarks/workload.h"
#include "tests/peers/flann_matching.h"
#ifdef CORRAL_WITH_PCL
#include "tests/peers/pcl_surface.h"
#endif

namespace corral::benchmarks {
namespace {

using benchmark::DoNotOptimize;

class Registry {
 public:
  explicit Registry(RatioTable& table) : table_(table) {}

  /// `peer` may be empty: no other library does this here.
  void add(Workload& load, const std::string& stage, const Setup& ours, const std::string& library, const Setup& peer) {
    const std::string vertices = std::to_string(load.mesh().vertices.rows());
    const std::size_t row = table_.add_row({{load.name(), vertices, stage}, peer ? library : "", 0, 0});
    table_.add_side(load.name() + "/" + stage + "/ours", ours, row, Side::Ours);
    if (peer) table_.add_side(load.name() + "/" + stage + "/" + library, peer, row, Side::Peer);
  }

 private:
  RatioTable& table_;
};

#ifdef CORRAL_WITH_PCL
using Pcl = peers::PclSurface;

/// A stage of PCL; its cloud is made before the clock starts, and so are the normals and keypoints (the same as ours).
Setup pcl(Workload& load, const std::function<void(Pcl&, Workload&)>& stage) {
  return [&load, stage]() -> Call {
    const auto surface = std::make_shared<Pcl>(load.mesh().vertices);
    surface->set_normals(load.normals());
    load.keypoints();
    return [surface, &load, stage] { stage(*surface, load); };
  };
}

struct PclStages {
  Setup resolution, normals, harris, iss, shot, fpfh, whole_match;
};

PclStages pcl_stages(Workload& load) {
  PclStages stages;
  stages.resolution = pcl(load, [](Pcl& surface, Workload&) { DoNotOptimize(surface.resolution()); });
  stages.normals = pcl(load, [](Pcl& surface, Workload&) { surface.estimate_normals(); });
  stages.harris = pcl(load, [](Pcl& surface, Workload& with) { surface.harris(3 * with.resolution()); });
  stages.iss =
      pcl(load, [](Pcl& surface, Workload& with) { surface.iss(6 * with.resolution(), 4 * with.resolution()); });
  stages.fpfh = pcl(load, [](Pcl& surface, Workload& with) {
    DoNotOptimize(surface.fpfh(with.keypoints(), 15 * with.resolution()).data());
  });
  stages.shot = pcl(load, [](Pcl& surface, Workload& with) { surface.shot(with.keypoints(), 15 * with.resolution()); });
  stages.whole_match = [&load]() -> Call {
    const auto source = std::make_shared<Pcl>(load.mesh().vertices);
    const auto target = std::make_shared<Pcl>(load.target().vertices);
    return [source, target] { DoNotOptimize(peers::match_with_pcl(*source, *target).resolution); };
  };
  return stages;
}
#else
struct PclStages {
  Setup resolution, normals, harris, iss, shot, fpfh, whole_match;
};
PclStages pcl_stages(Workload&) { return {}; }
#endif

Setup flann(Workload& load, int count, decltype(&peers::match_with_flann_tree) match) {
  return [&load, count, match]() -> Call {
    const auto& features = load.features(count);
    if (!features) return {};
    const auto source = std::make_shared<Eigen::MatrixXf>(features->first.features.cast<float>());
    const auto target = std::make_shared<Eigen::MatrixXf>(features->second.features.cast<float>());
    return [source, target, match] { DoNotOptimize(match(*source, *target).first.data()); };
  };
}

void add_stages(Registry& registry, Workload& load) {
  const Mesh& mesh = load.mesh();
  const PclStages theirs = pcl_stages(load);
  const auto ours = [](const Call& call) -> Setup { return [call] { return call; }; };
  registry.add(load, "resolution", ours([&mesh] { DoNotOptimize(ours::resolution(mesh)); }), "pcl", theirs.resolution);
  const auto pairs = [&load](double (*count)(const Mesh&, double)) -> Setup {
    return [&load, count]() -> Call {
      const double radius = 3 * load.resolution();
      return [&load, radius, count] { DoNotOptimize(count(load.mesh(), radius)); };
    };
  };
  registry.add(load, "within-3pr", pairs(ours::pairs_by_grid), "cgal", pairs(ours::pairs_by_tree));
  registry.add(load, "normals", ours([&mesh] { DoNotOptimize(ours::normals(mesh).data()); }), "cgal-20-nearest",
               ours([&mesh] { DoNotOptimize(ours::nearest_by_tree(mesh)); }));
  registry.add(load, "normals", ours([&mesh] { DoNotOptimize(ours::normals(mesh).data()); }), "pcl", theirs.normals);
  const Setup harris = [&load]() -> Call {
    const double resolution = load.resolution();
    return [&load, resolution] { DoNotOptimize(ours::harris(load.mesh(), resolution).data()); };
  };
  registry.add(load, "harris", harris, "pcl", theirs.harris);
  const Setup iss = [&load]() -> Call {
    const double resolution = load.resolution();
    return [&load, resolution] { DoNotOptimize(ours::iss(load.mesh(), resolution).data()); };
  };
  registry.add(load, "iss", iss, "pcl", theirs.iss);
  const Setup shot = [&load]() -> Call {
    load.normals(), load.keypoints();
    return [&load] {
      DoNotOptimize(ours::shot(load.mesh(), load.normals(), load.keypoints(), load.resolution()).vertices.data());
    };
  };
  registry.add(load, "shot", shot, "pcl", theirs.shot);
  const Setup fpfh = [&load]() -> Call {
    load.normals(), load.keypoints();
    return [&load] {
      DoNotOptimize(ours::fpfh(load.mesh(), load.normals(), load.keypoints(), load.resolution()).vertices.data());
    };
  };
  registry.add(load, "fpfh", fpfh, "pcl", theirs.fpfh);
  for (const int count : {1000, 5000}) {
    const Setup matching = [&load, count]() -> Call {
      const auto& features = load.features(count);
      if (!features) return {};
      return [&features] { DoNotOptimize(ours::matching(features->first, features->second).nearest.data()); };
    };
    const std::string stage = "match" + std::to_string(count);
    registry.add(load, stage, matching, "flann-linear", flann(load, count, peers::match_with_flann_linear));
    registry.add(load, stage, matching, "flann-kdtree", flann(load, count, peers::match_with_flann_tree));
  }
  const Setup whole = [&load]() -> Call {
    load.target();
    return [&load] { DoNotOptimize(ours::whole_match(load.mesh(), load.target()).report.matches); };
  };
  registry.add(load, "whole-match", whole, "pcl", theirs.whole_match);
}

int run(const Arguments& arguments) {
  std::vector<Workload> workloads = read_workloads(arguments.words, data_folder(CORRAL_DATA_FOLDER));
  if (workloads.empty()) return no_mesh();
  RatioTable table({"mesh", "vertices", "stage"}, arguments.as_csv);
  Registry registry(table);
  for (Workload& load : workloads) add_stages(registry, load);
  benchmark::RunSpecifiedBenchmarks(&table);
  return 0;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  return corral::benchmarks::run_program("surface_benchmark", argc, argv, corral::benchmarks::run);
}
