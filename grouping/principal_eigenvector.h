// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace corral {

/// The non-negative principal eigenvector, of unit length, of a symmetric non-negative matrix.
///
/// The matrix is seen as a graph. Each connected part has exactly one non-negative eigenvector (Perron and Frobenius), so
/// the answer does not depend on where an iteration starts; it is that of the part with the largest eigenvalue, zero
/// elsewhere. Parts whose eigenvalues agree to 1e-9 relative: the part with the lowest index.
///
/// Each part is solved by restarted Lanczos iteration with full orthogonalisation until |Mx - lambda x| <= 1e-12 lambda,
/// or until rounding lets it fall no further. A matrix without a positive entry: zero.
Eigen::VectorXd principal_eigenvector(const Eigen::MatrixXd& matrix);

}  // namespace corral
