// SPDX-License-Identifier: MIT
#include "grouping/graph/principal_eigenvector.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corral {
namespace {

constexpr double kTolerance = 1e-12;
constexpr Eigen::Index kKrylovDimension = 24;
constexpr int kMaximumRestarts = 10000;  // a guard against rounding, not a part of the definition

struct Eigenpair {
  double value = 0;
  Eigen::VectorXd vector;
};

class Solver {
 public:
  explicit Solver(const GraphMatrix& matrix) : matrix_(matrix) {}

  Eigenpair solve() {
    // Ones everywhere: such a start cannot be orthogonal to the answer.
    Eigenpair pair{0, Eigen::VectorXd::Ones(matrix_.size())};
    double previous_residual = std::numeric_limits<double>::infinity();
    Eigen::VectorXd product;
    for (int restart = 0; restart < kMaximumRestarts; ++restart) {
      pair = largest_ritz_pair(pair.vector);
      matrix_.multiply(pair.vector, product);
      const double residual = (product - pair.value * pair.vector).norm();
      if (residual <= kTolerance * pair.value) break;
      if (residual <= 1e3 * kTolerance * pair.value && residual > 0.5 * previous_residual) break;
      previous_residual = residual;
    }
    return pair;
  }

 private:
  /// The largest Ritz pair of the Krylov space of `start`, grown until the pair satisfies the tolerance or the space is
  /// full. Its vector is made non-negative: the answer has one sign, and what differs is an error.
  Eigenpair largest_ritz_pair(const Eigen::VectorXd& start) const {
    const Eigen::Index size = start.size();
    const Eigen::Index dimension = std::min(size, kKrylovDimension);
    Eigen::MatrixXd basis(size, dimension);
    Eigen::VectorXd diagonal(dimension), off_diagonal(dimension), next, projection;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    basis.col(0) = start.normalized();
    for (Eigen::Index used = 1;; ++used) {
      const auto span = basis.leftCols(used);
      matrix_.multiply(basis.col(used - 1), next);
      diagonal(used - 1) = basis.col(used - 1).dot(next);
      for (int pass = 0; pass < 2; ++pass) {
        projection.noalias() = span.transpose() * next;
        next.noalias() -= span * projection;
      }
      off_diagonal(used - 1) = next.norm();
      small.computeFromTridiagonal(diagonal.head(used), off_diagonal.head(used - 1));
      const double value = small.eigenvalues()(used - 1);
      const Eigen::VectorXd weights = small.eigenvectors().col(used - 1);
      const double residual = off_diagonal(used - 1) * std::abs(weights(used - 1));
      if (used == dimension || !(residual > 0.1 * kTolerance * value))
        return {value, (span * weights).cwiseAbs().normalized()};
      basis.col(used) = next / off_diagonal(used - 1);
    }
  }

  const GraphMatrix& matrix_;
};

/// The nodes that are connected with `first`, itself included, in the order found; takes them out of `unseen`.
Indices take_part_of(const GraphMatrix& matrix, int first, Eigen::VectorXd& unseen) {
  Indices part{first};
  unseen(first) = 0;
  auto left = static_cast<int>(unseen.sum());
  Eigen::VectorXd column;
  for (std::size_t next = 0; next < part.size() && left > 0; ++next) {
    matrix.get_column(part[next], column);
    for (Eigen::Index other = 0; other < column.size(); ++other)
      if (column(other) * unseen(other) > 0) unseen(other) = 0, part.push_back(static_cast<int>(other)), --left;
  }
  return part;
}

/// The largest row sum, which no eigenvalue exceeds.
double largest_row_sum(const GraphMatrix& matrix) {
  Eigen::VectorXd sums;
  matrix.multiply(Eigen::VectorXd::Ones(matrix.size()), sums);
  return sums.maxCoeff();
}

}  // namespace

Eigen::VectorXd principal_eigenvector(const GraphMatrix& matrix) {
  Eigen::VectorXd answer = Eigen::VectorXd::Zero(matrix.size()), unseen = Eigen::VectorXd::Ones(matrix.size());
  double best = 0;
  for (int first = 0; first < matrix.size(); ++first) {
    if (!(unseen(first) > 0)) continue;
    Indices part = take_part_of(matrix, first, unseen);
    std::sort(part.begin(), part.end());
    const bool is_whole = static_cast<int>(part.size()) == matrix.size();
    const auto copy = is_whole ? nullptr : matrix.restricted(part);
    const GraphMatrix& block = is_whole ? matrix : *copy;
    if (largest_row_sum(block) <= best * (1 + 1e-9)) continue;  // most parts need no solving
    const Eigenpair pair = Solver(block).solve();
    if (pair.value <= best * (1 + 1e-9)) continue;
    best = pair.value;
    answer.setZero();
    answer(part) = pair.vector;
  }
  return answer;
}

}  // namespace corral
