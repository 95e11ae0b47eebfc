// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/mesh_file.h"

namespace corral {

/// KITTI's velodyne scans, *.bin: x, y, z and a reflectance for each point, as 4-byte floats of the lowest byte first, and
/// nothing else. The reflectance is not read. Throws IoError: a file that ends within a point, an infinite coordinate.
StoredMesh parse_bin(const std::string& path, std::string_view content);

}  // namespace corral
