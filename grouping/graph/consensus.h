// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "grouping/columns/filter.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// How well the rows of a set agree with each other in their lengths, as TCF counts it:
///
///   F_ij = [ | |p_i - p_j| - |p'_i - p'_j| | < tolerance ],  F_ii = 1
///   sums_i = sum of F_ij over j in the set;   size = ceil(sqrt(sum of all))
///
/// A set of more than `sample` rows is counted against 500 of its rows at even steps, scaled up and rounded down.
class Consensus {
 public:
  /// `matches` must outlive it and hold points only; the tolerance is in mesh units.
  Consensus(const CorrespondenceSet& matches, double tolerance, int sample)
      : matches_(matches), tolerance_(tolerance), sample_(sample) {}

  struct Size {
    int rows = 0;
    std::int64_t sum = 0;
  };

  /// Bytes for sets of so many rows.
  static double memory(int rows);

  bool agree(int i, int j) const;

  /// The rows that agree with one row, itself included.
  Indices with(int row) const;

  /// The size of a set, and the sum of each of its rows.
  Size measure(const Indices& rows, Indices& sums) const;

  /// Whether floats are certain that size(rows) is below this one; a set that is sampled is never certain.
  bool is_smaller(const Indices& rows, int size) const;

 private:
  const CorrespondenceSet& matches_;
  double tolerance_;
  int sample_;
};

}  // namespace corral
