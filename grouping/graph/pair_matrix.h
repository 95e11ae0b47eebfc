// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/columns.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// A symmetric matrix over the rows of a table with a zero diagonal. Stored are the entries right of the diagonal, in rows
/// that start at a multiple of eight.
class PairMatrix {
 public:
  /// The rigidity ratio of every pair (compatibility.h); with `distinct` 0 where the two share a point.
  static PairMatrix of_ratios(const CorrespondenceSet& matches, bool distinct);

  /// 1 - (D/d)^2 where D = | |p_i - p_j| - |p'_i - p'_j| | < d, else 0; d in mesh units.
  static PairMatrix of_differences(const CorrespondenceSet& matches, double largest);

  /// Bytes for so many rows.
  static double memory(int rows) { return 4.0 * padded(rows) * (padded(rows) + kLanes) + 8.0 * rows; }

  int size() const { return rows_; }

  /// sums = M values, each sum in one fixed order on every machine. Both padded; the padding of `values` is 0.
  /// Plain form  tests/support/reference/game_theory.h
  void multiply(const AlignedColumn& values, AlignedColumn& sums) const;

  const double* from(int row) const {
    return &entries_[starts_[static_cast<std::size_t>(row)]];
  }  ///< column first(row)
  static int first(int row) { return row / kLanes * kLanes; }

 private:
  explicit PairMatrix(int rows);
  double* row_from_zero(int row) { return &entries_[starts_[static_cast<std::size_t>(row)]] - first(row); }

  int rows_;
  std::vector<std::size_t> starts_;
  AlignedColumn entries_;
};

}  // namespace corral
