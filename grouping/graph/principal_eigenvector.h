// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
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
  /// Rounds the numbers to the precision of the fastest product; then to = M numbers.
  virtual void round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const = 0;
  /// The number of positive entries of each row, and the sum of the squares of all entries.
  virtual Eigen::VectorXd degrees() const = 0;
  virtual double sum_of_squares() const = 0;
  /// column = M e_node.
  virtual void get_column(int node, Eigen::VectorXd& column) const = 0;
  /// The rows and columns of these nodes, which ascend.
  virtual std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const = 0;
  /// Becomes that.
  virtual void keep(const Indices& nodes) = 0;
};

/// A matrix of doubles.
class DenseGraph : public GraphMatrix {
 public:
  explicit DenseGraph(Eigen::MatrixXd matrix) : matrix_(std::move(matrix)) {}
  int size() const override { return static_cast<int>(matrix_.rows()); }
  void multiply(const Eigen::VectorXd& from, Eigen::VectorXd& to) const override {
    to.noalias() = matrix_.selfadjointView<Eigen::Lower>() * from;
  }
  void round_and_multiply(Eigen::VectorXd& numbers, Eigen::VectorXd& to) const override { multiply(numbers, to); }
  Eigen::VectorXd degrees() const override { return (matrix_.array() > 0).cast<double>().colwise().sum().transpose(); }
  double sum_of_squares() const override { return matrix_.squaredNorm(); }
  void get_column(int node, Eigen::VectorXd& column) const override { column = matrix_.col(node); }
  std::unique_ptr<GraphMatrix> restricted(const Indices& nodes) const override {
    return std::make_unique<DenseGraph>(matrix_(nodes, nodes));
  }
  void keep(const Indices& nodes) override { matrix_ = Eigen::MatrixXd(matrix_(nodes, nodes)); }

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
/// or until rounding prevents a further decrease. A matrix without a positive entry: zero.
Eigen::VectorXd principal_eigenvector(const GraphMatrix& matrix);

}  // namespace corral
