// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "kernel/columns.h"

namespace corral {

// The loops over the pairs of two surfaces, eight at a time. Only sources include this.

/// Columns of pairs; the normals are those of the target.
struct NormalColumns {
  const double* source[3];
  double* target[3];  ///< in; out: the mean of both
  double* agreement;  ///< out: the cosine
  double* is_pair;    ///< 1 or 0
  std::size_t size;   ///< padded
};

/// Leaves only pairs whose normals agree, the source's turned. Where most look against each other, one of the surfaces is
/// taken to be inside out.
void agree(const NormalColumns& normals, const Eigen::Matrix3d& rotation, double least_cosine);

/// Columns of pairs and what becomes of them: m = scale (place - centre), d = scale (source - target).
struct PairColumns {
  const AlignedColumn (&places)[3];
  const AlignedColumn (&source)[3];
  const AlignedColumn (&target)[3];
  const AlignedColumn (&normals)[3];
  const double* is_pair;  ///< 1 or 0
  Eigen::Vector3d centre;
  double scale;
};

/// What is multiplied with what.
enum class PairProducts {
  OfPlanes,    ///< the 13 columns of a point-to-plane residual: m n^T, n, n d
  OfPoints,    ///< the 7 that the three residuals of points share: m, 1, d
  OfEquations  ///< the 6 of the point-to-plane equations: m x n, n
};
int width_of(PairProducts products);

/// sum f f^T over the pairs begin .. end - 1 (whole registers), f their columns.
Eigen::MatrixXd add_products(PairProducts products, const PairColumns& pairs, std::size_t begin, std::size_t end);

}  // namespace corral
