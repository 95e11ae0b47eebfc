// SPDX-License-Identifier: MIT
#pragma once

// The same surface with its vertices in another order.

#include "kernel/surface/mesh/mesh.h"
#include "tests/support/row_order.h"

namespace corral::testing {

/// The triangles stay in their order.
inline Mesh renumbered(const Mesh& mesh, const Indices& old_row) {
  const Indices new_row = inverse_of(old_row);
  Mesh other{mesh.vertices(old_row, Eigen::all), mesh.triangles};
  for (int& corner : other.triangles.reshaped()) corner = new_row[static_cast<std::size_t>(corner)];
  return other;
}

}  // namespace corral::testing
