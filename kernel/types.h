// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace corral {

/// N points, one per row, in mesh units. Column-major: each coordinate is one contiguous column.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Rows of a table or vertices of a mesh, zero-based.
using Indices = std::vector<int>;

}  // namespace corral
