// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/view_triangulation.h"

namespace corral {

/// Share of a surface whose front a sensor sees, 0 .. 1: of the area of the faces, or where there are none of the vertices by
/// their normals. Of one view it is near 1, or the sensor stands on the other side. Absent if the mesh has neither.
std::optional<double> front_share(const Mesh& mesh, const ViewOptions& sensor);

/// From where a view was taken, by what its mesh tells: from its sensor; else from the origin, if that sees the front of at
/// least half of the surface, or the mesh tells nothing (a closed one has no side); else from far away, against the mean of its normals.
ViewOptions view_side(const Mesh& mesh);

}  // namespace corral
