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
constexpr Eigen::Index kKrylovDimension = 24;
constexpr int kMaximumRestarts = 10000;  // a guard against rounding, not a part of the definition

struct Eigenpair {
  double value = 0;
  Eigen::VectorXd vector;
};

/// A bound of the sine of the angle between a vector and the principal eigenvector, from its Rayleigh quotient and the
/// length of its residual; infinite if nothing is known.
///
/// The largest eigenvalue is at least the quotient v, the square of each other at most (sum of squares) - v^2. With a gap g
/// between the two, sine <= residual / g.
double sine_bound(double value, double residual, double sum_of_squares) {
  const double gap = value - std::sqrt(std::max(sum_of_squares * (1 + 1e-12) - value * value, 0.0));
  if (!(gap > 1e-3 * value)) return std::numeric_limits<double>::infinity();
  return (residual + 1e-13 * value) / gap;
}

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

/// The largest eigenvalue of a symmetric tridiagonal matrix, and its eigenvector of some length.
///
/// p_k = x - a_k, p_i = x - a_i - b_i^2 / p_(i+1): x is the largest eigenvalue where p_1 = 0 and all others are positive.
/// There p_1 is concave, so that Newton's steps from below stay below; where it is not, the interval is halved.
Eigenpair largest_of_tridiagonal(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index size) {
  Eigen::VectorXd p(size);
  double low = a.head(size).maxCoeff(), high = low + 2 * (size > 1 ? b.head(size - 1).maxCoeff() : 0), x = low;
  for (int step = 0; step < 100; ++step) {
    double slope = 1;
    p(size - 1) = x - a(size - 1);
    Eigen::Index i = size - 1;
    for (; i > 0 && p(i) > 0; --i) {
      const double ratio = b(i - 1) / p(i);
      p(i - 1) = x - a(i - 1) - b(i - 1) * ratio;
      slope = 1 + ratio * ratio * slope;
    }
    const bool is_below = i > 0 || p(0) < 0;
    (is_below ? low : high) = x;
    const double next = i > 0 ? 0.5 * (low + high) : x - p(0) / slope;
    if (i == 0 && std::abs(next - x) <= 1e-15 * std::abs(x)) break;
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  Eigenpair pair{x, Eigen::VectorXd(size)};
  pair.vector(0) = 1;
  for (Eigen::Index i = 1; i < size; ++i) pair.vector(i) = pair.vector(i - 1) * b(i - 1) / p(i);
  return pair;
}

/// Lanczos iteration with vectors rounded to the precision of a fast product. The result does not rely on the recurrence but
/// on the product of the final vector, which is the same combination of products as the vector is of basis vectors.
class LeaderSearch {
 public:
  LeaderSearch(const Subgraph& graph, double tie) : graph_(graph), tie_(tie) {}

  int run(Eigen::VectorXd& entries) {
    const Eigen::Index size = entries.size();
    Eigen::MatrixXd basis(size, kProducts), products(size, kProducts);
    Eigen::VectorXd diagonal(kProducts), off_diagonal(kProducts), next = entries, product, projection;
    double norm = next.norm();
    if (!(norm > 0)) return kUncertain;
    for (int used = 1;; ++used) {
      const int last = used - 1;
      next /= norm;
      graph_.matrix.round_and_multiply(next, product);
      product = product.cwiseProduct(graph_.takes_part);
      if (last > 0) {  // removes the components along the others that rounding introduced, also from the product
        projection.noalias() = basis.leftCols(last).transpose() * next;
        next.noalias() -= basis.leftCols(last) * projection;
        product.noalias() -= products.leftCols(last) * projection;
      }
      norm = next.norm();
      basis.col(last) = next / norm;
      products.col(last) = product / norm;
      projection.noalias() = basis.leftCols(used).transpose() * products.col(last);
      diagonal(last) = projection(last);
      next = products.col(last);
      next.noalias() -= basis.leftCols(used) * projection;
      norm = off_diagonal(last) = next.norm();
      const Eigenpair pair = largest_of_tridiagonal(diagonal, off_diagonal, used);
      const double residual = norm * std::abs(pair.vector(last)) / pair.vector.norm();
      const bool ends = used == kProducts || !(norm > 1e-9 * pair.value);
      if (!ends && !(sine_bound(pair.value, residual, graph_.sum_of_squares) < kWorthAsking)) continue;
      const double length = (basis.leftCols(used) * pair.vector).norm();
      const Eigen::VectorXd vector = basis.leftCols(used) * pair.vector / length;
      const Eigen::VectorXd image = products.leftCols(used) * pair.vector / length;
      const int leader = leader_of(vector, image);
      if (!ends && leader == kUncertain) continue;
      entries = image.cwiseMax(0);
      return leader;
    }
  }

 private:
  /// The first of the largest entries of the eigenvector x, from a unit vector near it and its product. An entry of the
  /// product is cos l times that of x, l the eigenvalue, and an error; kMargin is for the cosine and for rounding.
  int leader_of(const Eigen::VectorXd& vector, const Eigen::VectorXd& image) {
    const double value = vector.dot(image), residual = (image - value * vector).norm();
    const double sine = sine_bound(value, residual, graph_.sum_of_squares);
    if (!(sine < kWorthAsking && vector.sum() > sine * std::sqrt(vector.size()))) return kUncertain;  // near x, not -x
    Eigen::Index first = 0;
    const double most = image.maxCoeff(&first);
    const double no_tie = tie_ * (1 + kMargin) * (value + residual), surely_tie = tie_ * (1 - kMargin) * value;
    // Two rows differ by no more than all their entries.
    const double largest_error = sine * std::sqrt(graph_.degrees(first) + graph_.degrees.maxCoeff());
    graph_.matrix.get_column(static_cast<int>(first), column_of_first_);
    int leader = static_cast<int>(first), compared = 0;
    for (int node = 0; node < image.size(); ++node) {
      const double lead = most - image(node);
      if (lead > largest_error + no_tie || !(graph_.takes_part(node) > 0)) continue;
      if (lead + 2 * largest_error > surely_tie) {
        if (++compared > kCompared) return kUncertain;
        graph_.matrix.get_column(node, column_);
        const double difference = (column_of_first_ - column_).cwiseProduct(graph_.takes_part).norm();
        if (lead > sine * difference + no_tie) continue;
        if (difference > 0) return kUncertain;
      }
      leader = std::min(leader, node);
    }
    return leader;
  }

  static constexpr int kProducts = 8, kCompared = 8;
  static constexpr double kWorthAsking = 1e-2, kMargin = 1e-3;

  const Subgraph& graph_;
  const double tie_;
  Eigen::VectorXd column_of_first_, column_;
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

int leading_entry(const Subgraph& graph, double tie, Eigen::VectorXd& entries) {
  return LeaderSearch(graph, tie).run(entries);
}

}  // namespace corral
