// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernel/correspondence_set.h"

namespace corral {

// Loops of groupers over columns of doubles; every machine computes the same bits. Only sources include this.
// Plain form  tests/support/reference/groupers.h

/// ratios[i] = first[i] / second[i], NaN unless second[i] > 0.
void divide_columns(const double* first, const double* second, std::size_t count, double* ratios);

/// The lower class of a cut, and all classes: weight, and sum of values times weights.
struct ClassSums {
  double weight, sum;
};

/// n1 n2 (m1 - m2)^2 for the cuts behind each class.
void between_class_variances(const double* lower_weights, const double* lower_sums, const ClassSums& all,
                             std::size_t count, double* variances);

/// In which cell of a width from `low` on each number lies, `last` at most; a padded column.
void find_cells(const double* column, std::size_t count, const double (&low_width_last)[3], std::int32_t* cells);

/// agrees[i]: whether the distances of rows i and `seed` on the two sides differ by less than a tolerance.
void compare_with_seed(const CorrespondenceSet& matches, int seed, double tolerance, std::uint8_t* agrees);

}  // namespace corral
