// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "grouping/columns/filter.h"
#include "kernel/correspondence_set.h"

namespace corral {

/// The rows that the motion of a triangle (kernel/triangle_fit.h) can agree with, if it agrees with more than so many of them.
///
/// Two rows that a rigid motion carries to within tau of their targets keep their distance: | |p_i - p_j| - |p'_i - p'_j| | < 2 tau.
/// A set of more than n rows in agreement therefore holds none but rows that keep their distance to n others. This is
/// exact in floating point: what is compared is 2 tau and what follows.
///
/// Residuals lose at most 2^-48 of the largest coordinate (see PoseFilter), here of points and translation together. A computed
/// rotation is made of two frames. Of each, the axes are of length 1 to a few roundings and orthogonal but for an angle
/// of 2^-51 |a| |b| / (2 A), the error of the cross product of the edges a and b that gives the normal of a triangle of area A.
/// With no edge longer than 2 sqrt(3) units (FilterTable::unit()) that is at most 2^-51 6 / A, and changes lengths by less
/// than 2^-44 units / A for both frames. Nothing overflows or vanishes where the unit is between 2^-200 and 2^200; elsewhere no row
/// is left out.
class PossibleSupport {
 public:
  /// Lengths in mesh units; no triangle has an area of `smallest_area` or less on either side. All rows, in their order.
  PossibleSupport(const CorrespondenceSet& matches, double tolerance, double smallest_area);

  /// Bytes for so many rows.
  static double memory(int rows) {
    return 2 * FilterTable::memory(rows) + ConsistencyFilter::memory(rows) + 4.0 * rows +
           4.0 * padded(rows, ConsistencyFilter::kGroup);
  }

  /// Leaves the rows of sets of more than `count`, of later calls no fewer. The rows with the largest residuals come first, those
  /// of the best pose: a pose that is not much worse misses the same.
  void exceed(int count, const std::vector<double>& residuals);

  const FilterTable& rows() const { return left_; }

 private:
  const FilterTable table_;
  FilterTable left_;
  const double tolerance_;     ///< of differences of distances
  const bool is_exact_;        ///< whether the proof holds
  Indices rows_;               ///< that are left
  std::vector<int> partners_;  ///< of each row, itself among them: no fewer than there are
};

}  // namespace corral
