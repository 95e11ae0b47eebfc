// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "kernel/rigid_transform.h"

namespace corral {

/// Reads a rigid motion: 16 numbers, a 4x4 matrix row by row, p_target = R p_source + t in mesh units (".xf" files are the
/// same). Throws IoError if the file holds anything else, or if the matrix is not rigid (orthonormal to 1e-4, det +1, last
/// row 0 0 0 1), with the numbers that show it.
RigidTransform read_transform(const std::string& path);

/// The same as text, four lines of four numbers; reading it back gives the same doubles.
std::string transform_text(const RigidTransform& transform);

}  // namespace corral
