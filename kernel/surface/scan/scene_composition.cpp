// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/scene_composition.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/scan/heap.h"
#include "kernel/surface/scan/visibility.h"

namespace corral {
namespace {

constexpr const char* kWho = "compose_scenes";
constexpr int kHeaps = 4;      // for each scene that is asked for
constexpr int kSensors = 12;   // for each heap
constexpr double kCoarse = 4;  // spacing of the coarse scans used for choosing, in spacings of the later scans
constexpr double kPenalty = 0.5;

/// The bin that holds a value, the last one with its end; -1 if none does.
int bin_of(const std::array<double, 7>& edges, double value) {
  if (value == edges.back()) return 5;
  if (!(value >= edges.front() && value < edges.back())) return -1;
  return static_cast<int>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin()) - 1;
}

struct Bins {
  int occlusion, clutter;
  bool inside() const { return occlusion >= 0 && clutter >= 0; }
};

Bins bins_of(double occlusion_share, double clutter_share) {
  return {bin_of(VisibilityCounts::kOcclusion, 100 * occlusion_share),
          bin_of(VisibilityCounts::kClutter, 100 * clutter_share)};
}

/// What a scene would add to the existing pairs.
double gain(VisibilityCounts counts, const std::vector<Visibility>& shown) {
  double sum = 0;
  for (const Visibility& pair : shown) {
    const Bins bins = bins_of(pair.occlusion, pair.clutter);
    sum += bins.inside() ? 1.0 / (1 + counts.occlusion[static_cast<std::size_t>(bins.occlusion)]) +
                               1.0 / (1 + counts.clutter[static_cast<std::size_t>(bins.clutter)])
                         : -kPenalty;
    counts.add(pair.occlusion, pair.clutter);  // two pairs in one bin of a scene count less as well
  }
  return sum;
}

/// A heap, and what each of its sensors sees.
struct Candidate {
  ComposedScene scene;
  std::vector<RangeSensor> sensors;
  std::vector<std::vector<Visibility>> shown;
};

/// The number of objects of a scene: all allowed numbers in turn.
int object_count(int scene, const std::vector<const SurfaceTree*>& surfaces, const CompositionOptions& options) {
  const int available = static_cast<int>(surfaces.size());
  const int least = std::min(options.least_objects, available), most = std::min(options.most_objects, available);
  return least + scene % (most - least + 1);
}

/// So many of the first numbers, in random order.
Indices choose_objects(int count, int of, RandomStream& random) {
  Indices rows(static_cast<std::size_t>(of));
  std::iota(rows.begin(), rows.end(), 0);
  for (int i = 0; i < count; ++i)
    std::swap(rows[static_cast<std::size_t>(i)],
              rows[static_cast<std::size_t>(i) + random.below(static_cast<std::uint64_t>(of - i))]);
  rows.resize(static_cast<std::size_t>(count));
  return rows;
}

/// The box around all objects: its middle, and in `size` its diagonal.
Eigen::Vector3d middle_of(const PosedSurfaces& scene, double& size) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const PosedSurface& posed : scene) {
    const Points vertices = posed.world_from_mesh.apply(posed.surface->mesh().vertices);
    low = low.cwiseMin(vertices.colwise().minCoeff()), high = high.cwiseMax(vertices.colwise().maxCoeff());
  }
  size = (high - low).norm();
  return (low + high).transpose() / 2;
}

std::vector<RangeSensor> sensors_around(const PosedSurfaces& scene, RandomStream& random) {
  constexpr double kRadians = 0.017453292519943295, kDistance = 2.5;
  double size;
  const Eigen::Vector3d middle = middle_of(scene, size);
  std::vector<RangeSensor> sensors;
  for (int i = 0; i < kSensors; ++i) {
    const double turn = 360 * kRadians * random.uniform(), tilt = random.uniform(10, 60) * kRadians;
    const Eigen::Vector3d away(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), std::sin(tilt));
    sensors.push_back({middle + kDistance * size * away, middle, Eigen::Vector3d::UnitZ()});
  }
  return sensors;
}

Candidate make_candidate(const std::vector<const SurfaceTree*>& surfaces, const CompositionOptions& options,
                         int number) {
  RandomStream random(derive_seed(options.seed, "heap " + std::to_string(number)));
  Candidate candidate;
  candidate.scene.objects =
      choose_objects(object_count(number / kHeaps, surfaces, options), static_cast<int>(surfaces.size()), random);
  std::vector<const SurfaceTree*> chosen;
  for (const int row : candidate.scene.objects) chosen.push_back(surfaces[static_cast<std::size_t>(row)]);
  candidate.scene.world_from_object =
      heap(chosen, options.spacing, derive_seed(options.seed, "ways " + std::to_string(number)));
  const PosedSurfaces posed = candidate.scene.posed(surfaces);
  candidate.sensors = sensors_around(posed, random);
  RangeScanOptions coarse;
  coarse.spacing = kCoarse * options.spacing;
  coarse.grazing_deg = options.grazing_deg;
  for (const RangeSensor& sensor : candidate.sensors)
    candidate.shown.push_back(measure_visibility(posed, scan_range(posed, sensor, coarse)));
  return candidate;
}

void check(const std::vector<const SurfaceTree*>& surfaces, const CompositionOptions& options) {
  if (surfaces.empty()) throw InvalidInput(kWho, "objects", "none", "at least one");
  if (options.scenes < 1) throw InvalidInput(kWho, "scenes", options.scenes, "at least 1");
  if (options.least_objects < 1 || options.most_objects < options.least_objects)
    throw InvalidInput(kWho, "objects in a scene",
                       std::to_string(options.least_objects) + " to " + std::to_string(options.most_objects),
                       "at least 1, and no more at the least than at the most");
  require_positive(kWho, "spacing", options.spacing);
}

}  // namespace

void VisibilityCounts::add(double occlusion_share, double clutter_share) {
  const Bins bins = bins_of(occlusion_share, clutter_share);
  if (!bins.inside()) {
    ++outside;
    return;
  }
  ++occlusion[static_cast<std::size_t>(bins.occlusion)];
  ++clutter[static_cast<std::size_t>(bins.clutter)];
}

PosedSurfaces ComposedScene::posed(const std::vector<const SurfaceTree*>& surfaces) const {
  PosedSurfaces placed;
  for (std::size_t i = 0; i < objects.size(); ++i)
    placed.push_back({surfaces[static_cast<std::size_t>(objects[i])], world_from_object[i]});
  return placed;
}

std::vector<ComposedScene> compose_scenes(const std::vector<const SurfaceTree*>& surfaces,
                                          const CompositionOptions& options, const ParallelFor& parallel) {
  check(surfaces, options);
  std::vector<Candidate> candidates(static_cast<std::size_t>(kHeaps * options.scenes));
  parallel(static_cast<int>(candidates.size()), [&](int number) {
    candidates[static_cast<std::size_t>(number)] = make_candidate(surfaces, options, number);
  });
  VisibilityCounts counts;
  std::vector<ComposedScene> scenes;
  std::vector<char> taken(candidates.size(), 0);
  for (int i = 0; i < options.scenes; ++i) {
    double most = -std::numeric_limits<double>::infinity();
    std::size_t best = 0, best_sensor = 0;
    const auto fits = [&](std::size_t number) {  // as many objects as are its turn
      return !taken[number] &&
             static_cast<int>(candidates[number].scene.objects.size()) == object_count(i, surfaces, options);
    };
    for (std::size_t number = 0; number < candidates.size(); ++number)
      for (std::size_t sensor = 0; fits(number) && sensor < candidates[number].sensors.size(); ++sensor) {
        const double adds = gain(counts, candidates[number].shown[sensor]);
        if (adds > most) most = adds, best = number, best_sensor = sensor;
      }
    taken[best] = 1;
    candidates[best].scene.sensor = candidates[best].sensors[best_sensor];
    scenes.push_back(candidates[best].scene);
    for (const Visibility& pair : candidates[best].shown[best_sensor]) counts.add(pair.occlusion, pair.clutter);
  }
  return scenes;
}

}  // namespace corral
