// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>

#include "kernel/parallel.h"
#include "kernel/surface/matching/feature_distance.h"
#include "kernel/surface/matching/feature_projection.h"
#include "kernel/types.h"

namespace corral {

// Finding the few targets that may be the nearest two of a source feature. Only sources include this.

/// Memory of a search, made once for many features.
struct FilterScratch {
  FilterScratch(Eigen::Index dimension, int panels);

  /// The state of a source feature between the steps of its search.
  struct Query {
    int row = 0;
    Indices seeds, chosen;  ///< targets that are measured first; other candidates
    FloatColumn fine;       ///< scores of `chosen`
    int seed_count = 0, count = 0;
    TwoNearest nearest;
  };

  ProjectedFeatures rows;
  FloatColumn scores, tops;  ///< of a row with all targets, and of groups of targets
  FloatColumn groups;        ///< indices of those that reach a score
  Query queries[3];          ///< one looks for seeds, one for candidates, one measures them
};

/// Lower bounds |x' - y'| on all distances |x - y|, from a product of short rows of floats. Let D be the larger distance
/// of two targets that were measured: a target with |x' - y'| > D + errors of both rows is farther than these two, and is
/// discarded. The rest is compared by longer rows in the same way, and then measured.
class FeatureFilter {
 public:
  /// At least 64 targets; equal dimensions, at least one.
  FeatureFilter(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, const ParallelFor& parallel);

  /// Whether floats can carry the targets.
  bool usable() const { return error_ < std::numeric_limits<double>::infinity(); }

  static constexpr int kRows = 24;  ///< source features that are searched for together
  FilterScratch scratch() const { return {target_.rows(), panels_}; }

  /// Calls use(column, its two nearest) for `count` source features from `first` on, at most kRows.
  template <class Use>
  void search(Eigen::Index first, int count, FilterScratch& scratch, const Use& use) const {
    score(first, count, scratch);
    // While one feature is processed, the data of the next one are prefetched.
    for (int i = 0; i < count + 2; ++i) {
      if (i < count) choose_seeds(i, scratch, scratch.queries[i % 3]);
      if (i >= 1 && i <= count) choose_candidates(first, scratch, scratch.queries[(i - 1) % 3]);
      if (i >= 2) use(first + i - 2, measure_candidates(first, scratch, scratch.queries[(i - 2) % 3]));
    }
  }

 private:
  using Query = FilterScratch::Query;

  void pack(int first_panel, int end_panel);
  void score(Eigen::Index first, int count, FilterScratch& scratch) const;
  void choose_seeds(int row, FilterScratch& scratch, Query& query) const;
  void choose_candidates(Eigen::Index first, FilterScratch& scratch, Query& query) const;
  TwoNearest measure_candidates(Eigen::Index first, const FilterScratch& scratch, const Query& query) const;
  ScoreBound bound(double own_squared, double own_error, int steps) const;
  void fetch(const int* columns, int count) const;

  const Eigen::MatrixXd &source_, &target_;
  FeatureProjection projection_;
  int panels_ = 0;
  FloatColumn coarse_;  // panels of 64 targets, step by step; the last step is -|y'|^2 / 2
  FloatColumn fine_;    // rows of 64, the last number -|y'|^2 / 2
  std::vector<double> panel_errors_, panel_squared_;
  double error_ = std::numeric_limits<double>::infinity(), largest_squared_ = 0;  // over all targets
};

}  // namespace corral
