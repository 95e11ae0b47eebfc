// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral::testing {

/// Views of one object as a scanner would leave them: points in the coordinates of a sensor at the origin, each view
/// with noise and a choice of points of its own, no faces.
struct ObjectViews {
  std::vector<Mesh> views;
  std::vector<RigidTransform> world_from_view;

  RigidTransform between(int a, int b) const;  ///< b_from_a
};

/// So many views from all around, the same angle apart. Seeded.
ObjectViews object_views(int count, std::uint64_t seed);

}  // namespace corral::testing
