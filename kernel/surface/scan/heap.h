// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/surface/scan/range_scan.h"

namespace corral {

/// True if the two surfaces have a point in common where they stand.
bool touch(const PosedSurface& a, const PosedSurface& b);

/// How far a surface may move along a direction (unit vector, world) before one of its vertices meets a surface that stands
/// there, or a vertex of those meets it; infinite if none ever does. Of each mesh at most some 1500 vertices are looked at,
/// and edges that meet edges are not seen: whoever needs to be sure asks `touch`.
double free_path(const PosedSurface& moving, const PosedSurfaces& standing, const Eigen::Vector3d& direction);

/// Objects heaped on the floor z = 0 of the world, none touching another, about `gap` (mesh units) apart where they lean
/// on each other. The first lies in the middle, every other one is pushed over the floor or let down from above until it
/// meets what is there; of some ways to do so the one that leads closest to the middle is taken. Each lies on a side on
/// which it is low.
///
/// Returns   world_from_mesh of each.
/// Throws    InvalidInput unless the gap is finite and above zero.
std::vector<RigidTransform> heap(const std::vector<const SurfaceTree*>& objects, double gap, std::uint64_t seed);

}  // namespace corral
