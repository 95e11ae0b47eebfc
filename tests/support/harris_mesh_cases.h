// SPDX-License-Identifier: MIT
#pragma once

// What the tests of Harris 3D on meshes have in common.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/surface/harris_mesh.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/support/meshes.h"

namespace corral::testing {

constexpr MeshNeighborhood kNeighborhoods[] = {MeshNeighborhood::Rings, MeshNeighborhood::Ball,
                                               MeshNeighborhood::Adaptive};
constexpr MeshSelection kSelections[] = {MeshSelection::Fraction, MeshSelection::Clustering};

/// Neighbourhoods of some 20 vertices on the meshes of these tests, and selections that leave some candidates out.
inline HarrisMeshOptions options_of(MeshNeighborhood neighborhood, MeshSelection selection = MeshSelection::Fraction) {
  HarrisMeshOptions options;
  options.neighborhood = neighborhood;
  options.selection = selection;
  options.extent = 0.04;
  options.separation = 0.08;
  return options;
}

inline Mesh noisy_grid(std::uint64_t seed) { return add_gaussian_noise(grid(24, 20), 0.2, seed); }

inline int count_absent(const Eigen::VectorXd& response) { return static_cast<int>(response.array().isNaN().count()); }

/// Absent in the same rows, and elsewhere equal to 1e-9 of the value (of 1e-4 of the largest, where that is more: what is
/// left of a difference that cancels).
inline void expect_close(const Eigen::VectorXd& found, const Eigen::VectorXd& expected) {
  ASSERT_EQ(found.size(), expected.size());
  const double largest = expected.array().isNaN().select(0, expected).cwiseAbs().maxCoeff();
  for (int row = 0; row < found.size(); ++row) {
    ASSERT_EQ(std::isnan(found(row)), std::isnan(expected(row))) << row;
    if (std::isnan(expected(row))) continue;
    ASSERT_LE(std::abs(found(row) - expected(row)), 1e-9 * std::max(std::abs(expected(row)), 1e-4 * largest)) << row;
  }
}

inline void expect_identical(const Eigen::VectorXd& found, const Eigen::VectorXd& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (int row = 0; row < found.size(); ++row)
    ASSERT_TRUE(found(row) == expected(row) || (std::isnan(found(row)) && std::isnan(expected(row)))) << row;
}

}  // namespace corral::testing
