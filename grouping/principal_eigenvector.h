// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <utility>

#include "kernel/types.h"

namespace corral {

/// A symmetric non-negative matrix, seen as a graph with an edge for each positive entry.
class GraphMatrix {
 public:
  virtual ~GraphMatrix() = default;
  virtual int size() const = 0;
  /// to = M from. Both have the size of the matrix.
  virtual void multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const = 0;
  /// The number of positive entries of each row, and the sum of the squares of all entries.
  virtual Eigen::VectorXd degrees() const = 0;
  virtual double sum_of_squares() const = 0;
  /// column = M e_node.
  virtual void get_column(int node, Eigen::VectorXd& column) const = 0;
  /// The rows and columns of some nodes, in that order.
  virtual std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const = 0;
};

/// A matrix of doubles.
class DenseGraph : public GraphMatrix {
 public:
  explicit DenseGraph(Eigen::MatrixXd matrix) : matrix_(std::move(matrix)) {}
  int size() const override { return static_cast<int>(matrix_.rows()); }
  void multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const override {
    to.noalias() = matrix_.selfadjointView<Eigen::Lower>() * from;
  }
  Eigen::VectorXd degrees() const override { return (matrix_.array() > 0).cast<double>().colwise().sum().transpose(); }
  double sum_of_squares() const override { return matrix_.squaredNorm(); }
  void get_column(int node, Eigen::VectorXd& column) const override { column = matrix_.col(node); }
  std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const override {
    return std::make_unique<DenseGraph>(matrix_(nodes, nodes));
  }

 private:
  Eigen::MatrixXd matrix_;
};

/// The non-negative principal eigenvector, of unit length, of a symmetric non-negative matrix.
///
/// Each connected part of the graph has exactly one non-negative eigenvector (Perron and Frobenius), so the answer does
/// not depend on where an iteration starts; it is that of the part with the largest eigenvalue, zero elsewhere. Parts whose
/// eigenvalues agree to 1e-9 relative: the part with the lowest index.
///
/// Each part is solved by restarted Lanczos iteration with full orthogonalisation until |Mx - lambda x| <= 1e-12 lambda,
/// or until rounding lets it fall no further. A matrix without a positive entry: zero.
Eigen::VectorXd principal_eigenvector(const GraphMatrix& matrix);

/// Whether a vector that is this near to the answer (2-norm) will do.
using WillDo = std::function<bool(const Eigen::VectorXd& approximation, double error)>;

/// The same for some nodes of a connected graph, from a good start, and only as exactly as it is needed.
struct ConnectedProblem {
  const GraphMatrix& matrix;
  const Eigen::VectorXd& takes_part;  ///< 1 for the nodes that do, which are connected; 0 for the others
  const Eigen::VectorXd& start;       ///< zero where nobody takes part, not zero everywhere
  double sum_of_squares;              ///< of the entries between the nodes that take part
};
/// The error that `will_do` is told follows from the residual and from a bound of all other eigenvalues: the squares of all
/// eigenvalues add up to the squares of all entries. Where that bound is too weak, the answer is the converged one.
Eigen::VectorXd principal_eigenvector(const ConnectedProblem& problem, const WillDo& will_do);

/// Whether the nodes with a positive weight are connected among each other. The search begins where it is largest.
bool is_connected(const GraphMatrix& matrix, const Eigen::VectorXd& weights);

}  // namespace corral
