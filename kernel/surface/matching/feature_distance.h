// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>

namespace corral {

// The one place where the distance of two features is defined. Only sources include this, compiled without contraction.
//
// A squared distance adds up the rows in sixteen sums by row mod 16; of these the first eight and the last eight are added,
// then lane by lane, as everywhere (lanes-inl.h).
// Plain form  tests/support/reference/matching.h

/// The two nearest of the columns that were offered, in any order, each once.
struct TwoNearest {
  int column = std::numeric_limits<int>::max();
  double squared = std::numeric_limits<double>::infinity();
  double second_squared = std::numeric_limits<double>::infinity();

  void offer(int other, double value) {
    if (value < squared || (value == squared && other < column))
      second_squared = squared, squared = value, column = other;
    else if (value < second_squared)
      second_squared = value;
  }
};

/// A bound that falls as nearer columns are found: scores below it belong to columns that are no nearer.
struct ScoreBound {
  Eigen::Index dimension = 0;
  double scale = 1;            ///< of the projection
  double own_squared = 0;      ///< length of the row of the source feature
  double errors = 0;           ///< of both sides
  double largest_squared = 0;  ///< length of the rows of all targets
  int steps = 0;               ///< products in a score
  float least(double squared) const;
};

/// Columns that are offered.
struct OfferedColumns {
  const double* first;  ///< of the matrix
  Eigen::Index rows;    ///< of it
  const int* chosen;    ///< which are offered, so many
  int count;
  int ahead;  ///< memory of that many more is asked for
};

/// Offers all of them.
void offer(const double* feature, const OfferedColumns& columns, TwoNearest& nearest);

/// Offers those whose scores reach the bound, in turn.
void offer_scored(const double* feature, const OfferedColumns& columns, const float* scores, const ScoreBound& bound,
                  TwoNearest& nearest);

/// Offers all columns of `target` to each of `source` from `first` on.
void offer_all(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target, Eigen::Index first,
               std::vector<TwoNearest>& nearest);

}  // namespace corral
