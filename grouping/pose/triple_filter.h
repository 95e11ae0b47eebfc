// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/columns/filter.h"
#include "kernel/triangle_fit.h"

namespace corral {

/// Which of sixteen triples cannot have enough rows in agreement, found with less than their motions.
///
/// Of the motion of a triple (fit_triangles) the first component of residuals needs little, here computed with reciprocals
/// instead of quotients. Both computations err by a few roundings, which small areas A enlarge (in units of FilterTable): the
/// normals by 2^-51 6 / A (see PossibleSupport), and by as much the angle between the planes, whose cosine and sine are
/// sums of numbers of 48 in all, divided by the sum of the singular values, at least 2 sqrt(4/3 A A'). Residuals within the
/// table then differ by less than 2^-41 / A; twice that is allowed for. Floats add what they add in PoseFilter, of a motion that
/// carries the table no farther than 8 units.
class TripleFilter {
 public:
  /// Lengths in mesh units.
  TripleFilter(const FilterTable& table, double tolerance, double smallest_area);

  /// Whether anything is certain: not where the extent of the table is out of proportion to the smallest triangles.
  bool is_sharp() const { return is_sharp_; }

  /// Takes eight triples into the lanes `first` .. `first` + 7.
  void set(const LaneTriangles& source, const LaneTriangles& target, int first);

  /// One bit for each of sixteen triples: 0 only where its motion, if it has one, certainly agrees with no more than `hopeless` of these
  /// rows of the table. At most `looked_at` are looked at, and no more once that is certain of all.
  unsigned possible(const FilterTable& rows, int hopeless, int looked_at) const;

  struct Planes {
    float normal[3][kFloatLanes], offset[kFloatLanes];  ///< x' = normal p + offset, in units of the table
  };

 private:
  Eigen::Vector3d source_origin_;
  double target_origin_, unit_;
  float reach_;
  bool is_sharp_;
  Planes planes_;
};

/// The filters of the eight poses of triangles that were fitted together: as PoseFilter, bounds rounded up a little more.
struct LaneFilters {
  float rotation[9][kLanes], translation[3][kLanes], reach[kLanes], possible[kLanes];

  LaneFilters() = default;
  LaneFilters(const FilterTable& table, const LaneMotions& motions, double tolerance);
  PoseFilter get(int lane) const;
};

}  // namespace corral
