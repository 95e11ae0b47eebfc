// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/columns/filter.h"
#include "kernel/triangle_fit.h"

namespace corral {

/// Which of sixteen triples cannot have enough rows in agreement, found with less than their motions.
///
/// Of the motion of a triple (fit_triangles) one component of residuals needs little, here computed with reciprocals
/// instead of quotients. The three components take turns at first; then it is the one that has left the fewest
/// triples. Both computations err by a few roundings, which small areas A enlarge (in units of FilterTable): the
/// normals by 2^-51 6 / A (see PossibleSupport), and by as much the angle between the planes, whose cosine and sine
/// are sums of numbers of 48 in all, divided by the sum of the singular values, at least 2 sqrt(4/3 A A'). Residuals
/// within the table then differ by less than 2^-41 / A; twice that is allowed for. Floats add what they add in
/// PoseFilter, of a motion that carries the table no farther than 8 units.
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
  unsigned possible(const FilterTable& rows, int hopeless, int looked_at);

  /// What is known of the motion of a triple of the latest answer; `within` is that of LaneFilters.
  Slab slab(int lane) const { return {planes_.axis, static_cast<int>(planes_.most[lane]), -1}; }

  struct Planes {
    int axis;
    float normal[3][kFloatLanes], offset[kFloatLanes];  ///< p' on this axis = normal p + offset, in units of the table
    float most[kFloatLanes];                            ///< rows that possibly agree
  };

 private:
  static constexpr int kTrials = 60;  ///< calls in which the components take turns

  Eigen::Vector3d source_origin_, target_origin_;
  double unit_;
  float reach_;
  bool is_sharp_;
  int axis_ = 0;  ///< of the next triples
  int trials_ = 0;
  std::size_t left_on_[3] = {};  ///< triples, by component
  Planes planes_;
};

/// The filters of the eight poses of triangles that were fitted together: as PoseFilter, bounds rounded up a little more.
struct LaneFilters {
  float rotation[9][kLanes], translation[3][kLanes], reach[kLanes], possible[kLanes];
  /// The tolerance less the error of these filters: a component within it is within the tolerance in double, and therefore within
  /// the reach of TripleFilter, which is the tolerance and the error of that.
  float within[kLanes];

  LaneFilters() = default;
  LaneFilters(const FilterTable& table, const LaneMotions& motions, double tolerance);
  PoseFilter get(int lane) const;
};

}  // namespace corral
