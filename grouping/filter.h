// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"
#include "kernel/vectorized.h"

namespace corral {

// Filtered predicates: the decisions of doubles at the speed of floats.
//
// A grouper decides by comparing doubles: whether two distances differ by less than a tolerance, whether their ratio
// reaches a similarity, whether a residual is below a tolerance. Its loops over all pairs, or over all poses and matches,
// first ask a filter that computes in float and knows how wrong it can be. A filter has two answers:
//
//   possible   false only where the comparison of doubles is certainly false
//   certain    true only where the comparison of doubles is certainly true
//
// What is possible but not certain is decided again in double, and so is every count of possible cases that could change
// the answer of the method. Selections are therefore those of the double definition, on every vector level.
//
// The proof rests on one bound. A FilterTable holds the points in a unit in which no coordinate exceeds 1, each rounded
// once: an error of at most u = 2^-24. A difference of two coordinates is then off by at most 4 u, a vector by 4 sqrt(3) u,
// and its squared length by 3 u of itself more, however it is rounded. The square root of a squared float distance is
// therefore within 13 u of the length, plus the rounding of the double distance, which is nothing beside it:
constexpr double kFilterDistanceError = 16 * 0x1p-24;

/// The points of a table of matches as floats. Rows beyond the last, up to a whole number of lanes, are NaN: no
/// comparison holds for them. Where floats cannot hold the extent, all points are 0, which every filter finds possible
/// and not certain.
class FilterTable {
 public:
  explicit FilterTable(const CorrespondenceSet& matches);

  /// Bytes for so many rows.
  static double memory(int rows) { return 6.0 * sizeof(float) * padded(rows, kFloatLanes); }

  /// Some of its rows, in the same unit.
  FilterTable subset(const Indices& rows) const;

  int rows() const { return rows_; }
  int padded_rows() const { return padded(rows_, kFloatLanes); }
  const float* source(int axis) const { return source_[static_cast<std::size_t>(axis)].data(); }
  const float* target(int axis) const { return target_[static_cast<std::size_t>(axis)].data(); }

  /// Takes a row out of all comparisons; `show` takes what this returned.
  float hide(int row);
  void show(int row, float hidden) { source_[0][static_cast<std::size_t>(row)] = hidden; }

  bool is_blind() const { return is_blind_; }
  double unit() const { return unit_; }  ///< mesh units; a power of two
  const Eigen::Vector3d& source_origin() const { return source_origin_; }
  const Eigen::Vector3d& target_origin() const { return target_origin_; }

 private:
  FilterTable() = default;

  int rows_ = 0;
  bool is_blind_ = false;
  double unit_ = 1;
  Eigen::Vector3d source_origin_ = Eigen::Vector3d::Zero(), target_origin_ = Eigen::Vector3d::Zero();
  std::array<FloatColumn, 3> source_, target_;
};

/// | d - d' | < tolerance for the distances of two rows on either side.
///
/// For lengths x, y of floats, |x - y| < T means (a - b)^2 + T^4 < 2 T^2 (a + b) with a = x^2, b = y^2, unless x + y < T;
/// with max(a + b, T^2) for a + b it holds there too. T is the tolerance and twice the bound above.
struct ConsistencyFilter {
  ConsistencyFilter(const FilterTable& table, double tolerance);
  float square;  ///< T^2
  float fourth;  ///< T^4
  float factor;  ///< 2 T^2, with the rounding of the test
};

/// min(d, d') / max(d, d') >= similarity, or > similarity: which of them is for the double to say.
///
/// With x <= y the lengths of floats, e their bound and s the similarity, it is certain if x >= s y + e (1 + s), and
/// possible unless x + e (1 + s) < s y. Squared, with 2 y c <= h y^2 + c^2 / h for the mixed term, both are linear in x^2, y^2.
struct SimilarityFilter {
  explicit SimilarityFilter(double similarity);
  float certain_slope;   ///< certain if x^2 >= slope y^2 + offset
  float possible_slope;  ///< possible if x^2 + offset >= slope y^2
  float offset;
};

/// | T p - p' | < tolerance for one row under a motion T whose linear part is a rotation to 1e-3.
struct PoseFilter {
  PoseFilter() = default;
  PoseFilter(const FilterTable& table, const RigidTransform& target_from_source, double tolerance);
  float rotation[9];  ///< row by row
  float translation[3];
  float reach;     ///< possible only if no component of the residual exceeds it
  float possible;  ///< possible if the squared residual is at most this
  float certain;   ///< certain if it is below this
};

}  // namespace corral
