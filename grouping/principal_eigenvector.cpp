// SPDX-License-Identifier: MIT
#include "grouping/principal_eigenvector.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corral {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kKrylovDimension = 24;
constexpr int kMaximumRestarts = 10000;  // a guard against rounding, not a part of the definition

struct Eigenpair {
  double value = 0;
  Eigen::VectorXd vector;
};

/// The largest Ritz pair of the Krylov space of `start`, grown until the pair satisfies the tolerance or the space is
/// full.
Eigenpair largest_ritz_pair(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& start) {
  const Eigen::Index size = matrix.rows();
  const Eigen::Index dimension = std::min<Eigen::Index>(size, kKrylovDimension);
  Eigen::MatrixXd basis(size, dimension);
  Eigen::VectorXd diagonal(dimension), off_diagonal(dimension);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
  basis.col(0) = start.normalized();
  for (Eigen::Index used = 1;; ++used) {
    const auto span = basis.leftCols(used);
    Eigen::VectorXd next = matrix.selfadjointView<Eigen::Lower>() * basis.col(used - 1);
    diagonal(used - 1) = basis.col(used - 1).dot(next);
    for (int pass = 0; pass < 2; ++pass) next -= span * (span.transpose() * next);
    off_diagonal(used - 1) = next.norm();
    small.computeFromTridiagonal(diagonal.head(used), off_diagonal.head(used - 1));
    const double value = small.eigenvalues()(used - 1);
    const Eigen::VectorXd weights = small.eigenvectors().col(used - 1);
    const double residual = off_diagonal(used - 1) * std::abs(weights(used - 1));
    if (used == dimension || !(residual > 0.1 * kTolerance * value)) return {value, span * weights};
    basis.col(used) = next / off_diagonal(used - 1);
  }
}

Eigenpair perron_pair(const Eigen::MatrixXd& matrix) {
  const Eigen::Index size = matrix.rows();
  Eigenpair pair{0, Eigen::VectorXd::Ones(size)};  // everywhere positive: it cannot be orthogonal to the answer
  double previous_residual = std::numeric_limits<double>::infinity();
  for (int restart = 0; restart < kMaximumRestarts; ++restart) {
    pair = largest_ritz_pair(matrix, pair.vector);
    pair.vector = pair.vector.cwiseAbs().normalized();  // the answer has one sign; what differs is rounding
    const double residual = (matrix.selfadjointView<Eigen::Lower>() * pair.vector - pair.value * pair.vector).norm();
    if (residual <= kTolerance * pair.value) break;
    if (residual <= 1e3 * kTolerance * pair.value && residual > 0.5 * previous_residual) break;
    previous_residual = residual;
  }
  return pair;
}

/// The connected parts of the graph of non-zero entries, each ascending, in the order of their lowest index.
std::vector<std::vector<Eigen::Index>> connected_parts(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<Eigen::Index>> parts;
  std::vector<char> seen(static_cast<std::size_t>(matrix.rows()), 0);
  for (Eigen::Index first = 0; first < matrix.rows(); ++first) {
    if (seen[static_cast<std::size_t>(first)]) continue;
    seen[static_cast<std::size_t>(first)] = 1;
    std::vector<Eigen::Index> part{first};
    for (std::size_t next = 0; next < part.size(); ++next)
      for (Eigen::Index other = 0; other < matrix.rows(); ++other)
        if (matrix(other, part[next]) > 0 && !seen[static_cast<std::size_t>(other)])
          seen[static_cast<std::size_t>(other)] = 1, part.push_back(other);
    std::sort(part.begin(), part.end());
    parts.push_back(part);
  }
  return parts;
}

}  // namespace

Eigen::VectorXd principal_eigenvector(const Eigen::MatrixXd& matrix) {
  Eigen::VectorXd answer = Eigen::VectorXd::Zero(matrix.rows());
  double best = 0;
  const auto parts = connected_parts(matrix);
  if (parts.size() == 1 && matrix.rows() > 1) return perron_pair(matrix).vector;
  for (const auto& part : parts) {
    const Eigen::MatrixXd block = matrix(part, part);
    // An eigenvalue is at most the largest row sum: most parts need no solving.
    if (block.rowwise().sum().maxCoeff() <= best * (1 + 1e-9)) continue;
    const Eigenpair pair = perron_pair(block);
    if (pair.value <= best * (1 + 1e-9)) continue;
    best = pair.value;
    answer.setZero();
    answer(part) = pair.vector;
  }
  return answer;
}

}  // namespace corral
