// SPDX-License-Identifier: MIT
#pragma once

// Symmetric non-negative matrices, and their principal eigenvectors the long way.

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <vector>

#include "kernel/random.h"

namespace corral::testing {

/// Symmetric, entries 0 or in (0, 1); a chain of entries keeps it connected.
inline Eigen::MatrixXd random_connected(int size, double density, std::uint64_t seed, bool unit_diagonal) {
  RandomStream random(seed);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    if (unit_diagonal) matrix(i, i) = 1;
    for (int j = 0; j < i; ++j)
      if (random.uniform() < density || j == i - 1) matrix(i, j) = matrix(j, i) = random.uniform(0.01, 1.0);
  }
  return matrix;
}

inline Eigen::VectorXd dense_answer(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return solver.eigenvectors().rightCols<1>().cwiseAbs();
}

/// Unit diagonal and the ones of cliques of the given sizes, one after another.
inline Eigen::MatrixXd cliques(const std::vector<int>& sizes) {
  int total = 0;
  for (const int size : sizes) total += size;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(total, total);
  int first = 0;
  for (const int size : sizes) {
    matrix.block(first, first, size, size).setOnes();
    first += size;
  }
  return matrix;
}

}  // namespace corral::testing
