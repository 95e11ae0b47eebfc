// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernel/columns.h"

namespace corral {

// Features as short rows of floats whose distances are lower bounds. Only sources include this.

constexpr int kCoarseNumbers = 24;  ///< directions, the length of the rest, 1
constexpr int kFineNumbers = 64;    ///< the same with more directions; the first are those of the coarse row

/// Rows of projected features, and what is known of them. Made once for as many rows as a block has.
struct ProjectedFeatures {
  ProjectedFeatures(Eigen::Index dimension, int rows);

  FloatColumn numbers;                               ///< of each feature: moved, scaled and rounded
  FloatColumn coarse;                                ///< rows of 24
  FloatColumn fine;                                  ///< rows of 64
  std::vector<double> coarse_squared, fine_squared;  ///< squared lengths of the rows without their last number
  std::vector<double> error;                         ///< how far the row is from that of the feature itself, at most
};

/// A projection x -> x' = (Q^T x, |x - Q Q^T x|) with an orthonormal Q, of features x = scale (feature - center):
///
///   |x - y|^2 = |Q^T (x - y)|^2 + |rest(x) - rest(y)|^2 >= |Q^T (x - y)|^2 + (|rest(x)| - |rest(y)|)^2 = |x' - y'|^2
///
/// for any Q. A tight one spans the principal directions of the features; here those of a sample are followed by two
/// rounds of block power iteration. That is deterministic and needs no factorisation.
///
/// Error     Floats carry x' with an error of at most `error` (Euclidean), for every x; see project().
class FeatureProjection {
 public:
  /// At least one column in either; equal numbers of rows, at least one.
  FeatureProjection(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target);

  /// Whether floats can carry the features at all: not where they are so large or small that doubles overflow, too.
  bool usable() const { return usable_; }

  /// A power of two.
  double scale() const { return scale_; }

  /// Projects `count` columns from `first` on; the last number of each row becomes 1. A feature that lies 1e15 times as
  /// far from the centre as the sample has an infinite error.
  void project(const Eigen::MatrixXd& features, Eigen::Index first, int count, ProjectedFeatures& out) const;

 private:
  void choose_scale(const Eigen::MatrixXd& sample);
  void find_directions(const Eigen::MatrixXd& sample);
  void round_directions(AlignedColumn& directions);
  void measure_directions(const AlignedColumn& directions);
  void round_features(const Eigen::MatrixXd& features, Eigen::Index first, int count, float* numbers,
                      double* squared) const;
  void finish_row(double squared, int row, ProjectedFeatures& out) const;

  Eigen::Index dimension_;
  Eigen::VectorXd center_;
  double scale_ = 1;
  double relative_error_ = 0;  // of Q^T x, as a multiple of |x|
  bool usable_ = false;
  FloatColumn panel_;  // Q, row by row: 64 floats, of which 62 are directions
};

}  // namespace corral
