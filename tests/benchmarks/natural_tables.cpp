// SPDX-License-Identifier: MIT
#include "tests/benchmarks/natural_tables.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "apps/pair/match_pair.h"
#include "kernel/evaluation.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"

namespace corral::benchmarks {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kNoise_pr = 0.3;
constexpr double kSeenShare = 0.3;
constexpr double kInlier_pr = 4;

/// From few keypoints to many.
struct Density {
  const char *detector, *option, *pr;
};
constexpr Density kDensities[] = {{"harris", "radius_pr", "3"},
                                  {"harris", "radius_pr", "2"},
                                  {"harris", "radius_pr", "1.5"},
                                  {"uniform", "spacing_pr", "1.5"},
                                  {"uniform", "spacing_pr", "1"}};

/// The share of the vertices that is farthest along x, with the triangles among them.
Mesh part_of(const Mesh& mesh, double share) {
  const Indices order = rows_by_place(mesh.vertices);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(order.size()));
  const Indices kept(order.end() - static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<int> number(order.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) number[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
  Mesh part;
  part.vertices = mesh.vertices(kept, Eigen::all);
  part.triangles = mesh.triangles.unaryExpr([&](int vertex) { return number[static_cast<std::size_t>(vertex)]; });
  Indices faces;
  for (int face = 0; face < part.triangles.rows(); ++face)
    if (part.triangles.row(face).minCoeff() >= 0) faces.push_back(face);
  part.triangles = Triangles(part.triangles(faces, Eigen::all));
  return part;
}

CorrespondenceSet matches_of(const Mesh& source, const Mesh& target, const Density& density) {
  MatchSettings settings;
  settings.detector = density.detector;
  settings.options[density.detector][density.option] = density.pr;
  settings.threads = 1;
  return match_pair(source, target, settings).matches;
}

/// `count` rows, evenly spread.
CorrespondenceSet spread(const CorrespondenceSet& matches, int count) {
  Indices rows;
  for (int i = 0; i < count; ++i) rows.push_back(static_cast<int>(std::int64_t{i} * matches.size() / count));
  return select_rows(matches, rows);
}

double inlier_ratio(const CorrespondenceSet& matches, const RigidTransform& truth) {
  double inliers = 0;
  for (const bool is_inlier : label_correct(matches, truth, kInlier_pr)) inliers += is_inlier;
  return inliers / matches.size();
}

void add_tables(const std::string& scene, const Mesh& source, const Mesh& target, const RigidTransform& truth,
                const std::vector<int>& sizes, std::vector<NaturalTable>& tables) {
  CorrespondenceSet all;
  auto density = std::begin(kDensities);
  for (const int size : sizes) {
    while (all.size() < size && density != std::end(kDensities)) all = matches_of(source, target, *density++);
    if (all.size() < size) return;
    tables.push_back({scene, spread(all, size), 0});
    tables.back().inlier_ratio = inlier_ratio(tables.back().matches, truth);
  }
}

}  // namespace

std::vector<NaturalTable> natural_tables(Workload& load, const std::vector<int>& sizes) {
  const RigidTransform truth = random_motion(load.mesh(), kSeed);
  std::vector<NaturalTable> tables;
  const auto add = [&](const std::string& scene, const Mesh& seen) {
    const Mesh target = add_gaussian_noise(move_mesh(seen, truth), kNoise_pr * load.resolution(), kSeed);
    add_tables(scene, load.mesh(), target, truth, sizes, tables);
  };
  add(load.name(), load.mesh());
  add(load.name() + ":part", part_of(load.mesh(), kSeenShare));
  return tables;
}

std::function<void()> in_turn(const CorrespondenceSet& matches, std::function<void(const CorrespondenceSet&)> use) {
  const auto tables = std::make_shared<std::vector<CorrespondenceSet>>();
  Indices order(static_cast<std::size_t>(matches.size()));
  std::iota(order.begin(), order.end(), 0);
  RandomStream random(kSeed);
  for (int table = std::clamp(16000 / std::max(matches.size(), 1), 1, 64); table > 0; --table) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    tables->push_back(select_rows(matches, order));
  }
  return [tables, use, next = std::size_t{0}]() mutable { use((*tables)[next++ % tables->size()]); };
}

}  // namespace corral::benchmarks
