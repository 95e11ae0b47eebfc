// SPDX-License-Identifier: MIT
// icp_pairs DATASET...: dense refinement of every pair of some data sets from a start 3 degrees and 3 pr off its truth, by
// planes and by points, beside point-to-point iterative closest points of other libraries (as many rounds as ours take, at
// least 50; points up to 4 pr apart are paired, as on our last level). One line a set and way: over the pairs that all ways
// left within 5 pr of the truth the median rotation error and RMSE over the overlap, how many pairs that way left there, and
// on how many of those of all its RMSE is below that of ours by planes by more than 0.01 pr. With --each, a line a pair too.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/match_pair.h"
#include "io/mesh/mesh_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"
#include "kernel/random.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/search/nearest_points.h"
#include "kernel/surface/search/resolution.h"
#include "refine/refine_surface.h"
#include "tests/peers/icp.h"

namespace corral::peers {
namespace {

constexpr double kAngle_deg = 3, kShift_pr = 3, kThere_pr = 5, kMargin_pr = 0.01;
constexpr int kFewestRounds = 50;

struct Outcome {
  double rotation_deg = INFINITY, rmse_pr = INFINITY;
  bool is_there() const { return rmse_pr <= kThere_pr; }
};

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What each way makes of one pair, in the order of `kWays`.
const std::vector<std::string> kWays = {
    "planes",
    "points",
#ifdef CORRAL_WITH_PCL
    "pcl",
#endif
#ifdef CORRAL_WITH_OPEN3D
    "open3d",
#endif
};

std::vector<Outcome> try_all(const Mesh& source, const Mesh& target, const RigidTransform& truth, double resolution,
                             std::uint64_t seed) {
  const PairTruth known = pair_truth(source, target, truth, resolution, 4);
  RandomStream random(seed);
  const Eigen::Vector3d middle = vertex_centroid(source);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(kAngle_deg * M_PI / 180, random.direction()).toRotationMatrix();
  const RigidTransform start =
      truth * RigidTransform{turn, middle - turn * middle + kShift_pr * resolution * random.direction()};
  std::vector<Outcome> outcomes;
  const auto judge = [&](const std::optional<RigidTransform>& pose) {
    outcomes.emplace_back();
    if (!pose) return;
    const PoseErrors errors = pose_errors(*pose, known, resolution);
    outcomes.back().rotation_deg = errors.rotation_error_deg;
    if (errors.points) outcomes.back().rmse_pr = errors.points->rmse_pr;
  };
  const PointTree tree(target.vertices);
  NearestTracker tracker(tree);
  const Points source_normals = estimate_normals(source), target_normals = estimate_normals(target);
  int rounds = kFewestRounds;
  for (const SurfaceResidual residual : {SurfaceResidual::PointToPlane, SurfaceResidual::PointToPoint}) {
    SurfaceOptions options;
    options.residual = residual;
    const RefinedSurface found = refine_surface(
        {{source.vertices, source_normals},
         {target.vertices, target_normals},
         resolution,
         [&](const Points& queries, double limit) -> const PointPairs& { return tracker.pair(queries, limit); }},
        start, options);
    int taken = 0;
    for (const auto& level : found.levels) taken += static_cast<int>(level.size());
    rounds = std::max(rounds, taken);
    judge(found.target_from_source);
  }
#ifdef CORRAL_WITH_PCL
  judge(pcl_icp(source.vertices, target.vertices)(start, 4 * resolution, rounds).target_from_source);
#endif
#ifdef CORRAL_WITH_OPEN3D
  judge(open3d_icp(source.vertices, target.vertices)(start, 4 * resolution, rounds).target_from_source);
#endif
  return outcomes;
}

void compare_on(const std::string& folder, bool each) {
  const Dataset dataset = read_dataset(folder);
  std::vector<std::vector<Outcome>> all;
  for (const DatasetPair& pair : dataset.pairs) {
    if (pair.truth.empty()) continue;
    const Mesh source = read_mesh(dataset.path(pair.source)), target = read_mesh(dataset.path(pair.target));
    const double resolution =
        pair_resolution(dataset.resolution, point_resolution(source.vertices), point_resolution(target.vertices));
    all.push_back(try_all(source, target, read_transform(dataset.path(pair.truth)), resolution, all.size()));
    if (!each) continue;
    std::printf("%s", pair.name.c_str());
    for (const Outcome& outcome : all.back()) std::printf("  %.4f deg %.4f pr", outcome.rotation_deg, outcome.rmse_pr);
    std::printf("\n");
  }
  for (std::size_t way = 0; way < kWays.size(); ++way) {
    std::vector<double> angles, errors;
    int there = 0, better = 0;
    for (const auto& outcomes : all) {
      there += outcomes[way].is_there();
      if (!std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return outcome.is_there(); }))
        continue;
      angles.push_back(outcomes[way].rotation_deg);
      errors.push_back(outcomes[way].rmse_pr);
      better += outcomes[way].rmse_pr < outcomes[0].rmse_pr - kMargin_pr;
    }
    std::printf("%-10s %-7s %zu pairs, %zu by all: %.3f deg, %.4f pr; %d there; better than planes on %d\n",
                dataset.name.c_str(), kWays[way].c_str(), all.size(), angles.size(), median(angles), median(errors),
                there, better);
  }
}

}  // namespace
}  // namespace corral::peers

int main(int argc, char** argv) {
  try {
    const bool each = argc > 1 && std::strcmp(argv[1], "--each") == 0;
    const int first = each ? 2 : 1;
    if (argc <= first) return std::fprintf(stderr, "usage: icp_pairs [--each] DATASET...\n"), 2;
    for (int i = first; i < argc; ++i) corral::peers::compare_on(argv[i], each);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "icp_pairs: %s\n", error.what()), 3;
  }
}
