// SPDX-License-Identifier: MIT
#pragma once

namespace corral {

// The loops of FeatureProjection in doubles. Only sources include this.

/// Columns one behind the other.
template <class Number>
struct Columns {
  Number* first;
  int length;  ///< of each; a multiple of kLanes where they are directions
  int count;
};

/// Gram-Schmidt, one column after the other; a column that depends on those before it becomes zero.
void orthonormalise(const Columns<double>& columns);

/// Frobenius norm of Q^T Q - I over the columns that are not zero.
double orthonormality_defect(const Columns<const double>& columns);

/// (column - center) * scale as floats, and the squared lengths before they are rounded.
void scale_and_round(const Columns<const double>& columns, const double* center, double scale, float* rounded,
                     double* squared);

}  // namespace corral
