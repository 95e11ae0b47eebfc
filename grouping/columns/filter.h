// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "kernel/columns.h"
#include "kernel/correspondence_set.h"
#include "kernel/rigid_transform.h"

namespace corral {

// Filtered predicates: the decisions of doubles at the speed of floats.
//
// A grouper decides by comparing doubles: whether two distances differ by less than a tolerance, whether their ratio
// reaches a similarity, whether a residual is below a tolerance. Its loops over all pairs, or over all poses and matches,
// first use a filter that computes in float with a known error bound. A filter gives two answers:
//
//   possible   false only where the comparison of doubles is certainly false
//   certain    true only where the comparison of doubles is certainly true
//
// What is possible but not certain is decided again in double, and so is every count of possible cases that could change
// the answer of the method. Selections are therefore those of the double definition, on every machine.
//
// The proof rests on one bound. A FilterTable holds the points in a unit in which no coordinate exceeds 1, each rounded
// once: an error of at most u = 2^-24. A difference of two coordinates is then off by at most 4 u, a vector by 4 sqrt(3) u,
// and its squared length by 3 u of itself more, however it is rounded. The square root of a squared float distance is
// therefore within 13 u of the length, plus the rounding of the double distance, which is negligible:
constexpr double kFilterDistanceError = 16 * 0x1p-24;

/// The points of a table of matches as floats. Rows beyond the last, up to a whole number of lanes, are NaN: no
/// comparison holds for them. Where floats cannot hold the extent, all points are 0, which is possible and not certain for
/// every filter.
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

  /// Excludes a row from all comparisons; `show` with the returned value includes it again.
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

/// | d - d' | < tolerance for the distances of two rows on either side, in a unit of twice T: the tolerance, widened by the
/// error of the points. In this unit, for the true lengths x, y of the floats, |x - y| < 1/2 implies F^2 <= x^2 + 1/16 with
/// F = y^2 - x^2 - 1/4: F <= x because y^2 < (x + 1/2)^2, and -F <= x because y^2 > (x - 1/2)^2, unless x < 1/2; then
/// -F <= x^2 + 1/4, whose square is x^2 + (x^2 - 1/4)^2.
///
/// Squared distances come from scalar products, x^2 = |p|^2 + |q|^2 - 2 pq, half the operations of differences. With no
/// point farther than R from the middle, a coordinate is rounded twice, by at most 2 u R in all, and x^2 is off by 16 u R^2
/// for it. Its three products and sums round numbers of at most 3 R^2: at most 13 u R^2. F holds two such squares and four
/// more roundings of at most 8 R^2, so that it is off by less than E = 96 u (R^2 + 1), and F^2 by 2 E (2 R + 1) + E^2. One E
/// more is for x^2 and for the roundings of the test.
class ConsistencyFilter {
 public:
  ConsistencyFilter(const FilterTable& table, double tolerance);

  /// Bytes for so many rows.
  static double memory(int rows) { return 16.0 * sizeof(float) * padded(rows, kGroup); }

  /// What a row contributes to its comparisons with others.
  struct Row {
    float source[3], target[3];  ///< times -2
    float offset;                ///< of F: |q|^2 - |p|^2 - 1/4
    float surplus;               ///< |p|^2 + 1/16 and all errors: possible if F^2 - surplus <= x^2 - |p|^2
  };

  static constexpr int kGroup = 2 * kFloatLanes;  ///< rows that are compared together with each other row
  int padded_rows() const { return static_cast<int>(rows_.size()); }
  const Row& row(int i) const { return rows_[static_cast<std::size_t>(i)]; }
  const float* source(int axis) const { return source_[static_cast<std::size_t>(axis)].data(); }
  const float* target(int axis) const { return target_[static_cast<std::size_t>(axis)].data(); }
  const float* source_square() const { return source_square_.data(); }
  const float* target_square() const { return target_square_.data(); }

 private:
  std::array<FloatColumn, 3> source_, target_;
  FloatColumn source_square_, target_square_;
  std::vector<Row> rows_;
};

/// min(d, d') / max(d, d') >= similarity, or > similarity: which of the two is decided in double.
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

/// What is known of one component of the residuals under a pose: no more than `most` rows are in agreement, among which those whose
/// computed component is at most `within` are counted, in agreement or not.
struct Slab {
  int axis = 0, most = 0;
  float within = -1;
};

}  // namespace corral
