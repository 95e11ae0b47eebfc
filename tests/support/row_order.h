// SPDX-License-Identifier: MIT
#pragma once

// Rows in another order, and back.

#include <algorithm>
#include <numeric>

#include "kernel/random.h"
#include "kernel/types.h"

namespace corral::testing {

/// Old row of each new row, at random.
inline Indices shuffled_rows(Eigen::Index count, std::uint64_t seed) {
  Indices old_row(static_cast<std::size_t>(count));
  std::iota(old_row.begin(), old_row.end(), 0);
  RandomStream random(seed);
  for (std::size_t i = old_row.size(); i > 1; --i) std::swap(old_row[i - 1], old_row[random.below(i)]);
  return old_row;
}

/// New row of each old one.
inline Indices inverse_of(const Indices& old_row) {
  Indices new_row(old_row.size());
  for (std::size_t i = 0; i < old_row.size(); ++i) new_row[static_cast<std::size_t>(old_row[i])] = static_cast<int>(i);
  return new_row;
}

/// New rows by their old names, ascending.
inline Indices by_old_name(const Indices& rows, const Indices& old_row) {
  Indices names;
  for (const int row : rows) names.push_back(old_row[static_cast<std::size_t>(row)]);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace corral::testing
