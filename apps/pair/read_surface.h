// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// A mesh that has a resolution; .txt is a list of points, as .xyz is. Throws IoError as read_mesh does, or if it has fewer
/// than two distinct vertices.
Mesh read_surface(const std::string& path);

}  // namespace corral
