// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/surface/scan/range_scan.h"

namespace corral {

/// Counts of (model, scene) pairs by occlusion and by clutter, in percent: the bins of the paper's figures.
struct VisibilityCounts {
  static constexpr std::array<double, 7> kOcclusion = {60, 65, 70, 75,
                                                       80, 85, 95};  ///< edges; the last bin with its end
  static constexpr std::array<double, 7> kClutter = {65, 70, 75, 80, 85, 90, 95};
  std::array<int, 6> occlusion{}, clutter{};
  int outside = 0;  ///< pairs outside the bins of one of the two, counted in neither

  /// Counts a pair; shares of 1, as measure_visibility has them.
  void add(double occlusion_share, double clutter_share);
};

struct CompositionOptions {
  int scenes = 12;
  int least_objects = 4, most_objects = 5;  ///< in a scene, alternating; each object at most once
  double spacing = 0;                       ///< of the later scans, mesh units; required
  double grazing_deg = 80;                  ///< of the later scans
  std::uint64_t seed = 1;
};

/// Some of the objects in a heap, in front of a sensor.
struct ComposedScene {
  Indices objects;  ///< rows of the list of objects
  std::vector<RigidTransform> world_from_object;
  RangeSensor sensor;

  /// The objects in their poses.
  PosedSurfaces posed(const std::vector<const SurfaceTree*>& surfaces) const;
};

/// Scenes whose pairs spread over the bins of occlusion and clutter: from four times as many heaps, each scanned coarsely
/// from twelve sensors, the scene is chosen one after the other that adds most to the emptiest bins. No object touches
/// another. The sensors look down at 10 to 60 degrees.
///
/// Throws    InvalidInput: no object, or an option out of range.
std::vector<ComposedScene> compose_scenes(const std::vector<const SurfaceTree*>& surfaces,
                                          const CompositionOptions& options, const ParallelFor& parallel = one_by_one);

}  // namespace corral
