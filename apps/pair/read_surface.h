// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "io/mesh/mesh_file.h"

namespace corral {

/// A mesh that has a resolution. Throws IoError as read_mesh does, or if it has fewer than two distinct vertices.
StoredMesh read_surface(const std::string& path);

}  // namespace corral
