// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "kernel/surface/mesh/mesh.h"

namespace corral::testing {

/// The square that the files of several formats hold: two triangles at z = 0.5.
inline void expect_square(const Mesh& mesh) {
  Points vertices(4, 3);
  vertices << 0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  EXPECT_EQ(mesh.vertices, vertices);
  EXPECT_EQ(mesh.triangles, triangles);
}

}  // namespace corral::testing
