// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "kernel/columns.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// The payoffs of GTM, a symmetric matrix with a zero diagonal (see game_theory.h). Stored are the entries right of the
/// diagonal, in rows that start at a multiple of eight.
class Payoffs {
 public:
  Payoffs(const CorrespondenceSet& matches, bool distinct);

  /// Bytes for so many rows.
  static double memory(int rows) { return 4.0 * padded(rows) * (padded(rows) + kLanes) + 8.0 * rows; }

  int size() const { return rows_; }

  /// gains = M shares, the sums in one fixed order on every machine. Both padded; the padding of `shares` is 0.
  /// Plain form  tests/support/reference_game_theory.h
  void multiply(const AlignedColumn& shares, AlignedColumn& gains) const;

  const double* from(int row) const {
    return &entries_[starts_[static_cast<std::size_t>(row)]];
  }  ///< column first(row)
  static int first(int row) { return row / kLanes * kLanes; }

 private:
  int rows_;
  std::vector<std::size_t> starts_;
  AlignedColumn entries_;
};

}  // namespace corral
