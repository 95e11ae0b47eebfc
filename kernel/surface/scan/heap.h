// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/surface/scan/range_scan.h"

namespace corral {

/// True if the two surfaces have a point in common where they stand.
bool touch(const PosedSurface& a, const PosedSurface& b);

/// How far a surface may move along a direction (unit vector, world) before one of its vertices meets one of the `standing`
/// surfaces, or a vertex of these meets it; infinite if that never happens. At most about 1500 vertices of each mesh are
/// tested, and edges that meet edges are missed: `touch` decides exactly.
double free_path(const PosedSurface& moving, const PosedSurfaces& standing, const Eigen::Vector3d& direction);

/// Objects heaped on the floor z = 0 of the world, none touching another, about `gap` (mesh units) apart where they lean
/// on each other. The first lies in the middle, every other one is pushed along the floor or lowered from above until it
/// meets the others; of several ways to do so, the one that ends closest to the middle is chosen. Each object rests on a
/// side on which it is low.
///
/// Returns   world_from_mesh of each.
/// Throws    InvalidInput unless the gap is finite and above zero.
std::vector<RigidTransform> heap(const std::vector<const SurfaceTree*>& objects, double gap, std::uint64_t seed);

}  // namespace corral
